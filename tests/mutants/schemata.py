"""Writes many mutants into one copy of a file: each change behind a question which one is chosen."""

import re


class Mutant:
    """One change of one place. `n` is its number in the program."""

    def __init__(self, n, folder, place, kind, edits):
        self.n, self.folder, self.place, self.kind, self.edits = n, folder, place, kind, edits


class Written:
    """The new text of a file, and which part of it belongs to which mutant."""

    def __init__(self, text, mutants):
        self.original, self.mutants, self.out, self.size, self.parts = text, mutants, [], 0, []
        groups = {}
        for m in mutants:
            for start, end, new in m.edits:
                groups.setdefault((start, end), []).append((m, new))
            if m.place.const_edit:
                groups.setdefault(m.place.const_edit[:2], [])
                groups.setdefault(m.place.const_span, []).append((m, ""))
        self.groups = groups
        self.const = {m.place.const_edit[:2]: m.place.const_edit[2] for m in mutants if m.place.const_edit}
        self.spans = sorted(groups, key=lambda span: (span[0], -span[1]))
        self.next = 0
        self.write_until(len(text), 0)
        self.text = "".join(self.out)
        self.line_starts = [0] + [i.end() for i in re.finditer("\n", self.text)]

    def put(self, text):
        self.out.append(text)
        self.size += len(text)

    def write_until(self, end, at):
        """Writes the original from `at` to `end`, with what is changed in between."""
        while self.next < len(self.spans) and self.spans[self.next][1] <= end:
            span = self.spans[self.next]
            self.next += 1
            self.put(self.original[at:span[0]])
            self.write_span(span)
            at = span[1]
        self.put(self.original[at:end])

    def write_span(self, span):
        if span in self.const:
            self.put(self.const[span])
            return
        # What leaves a whole statement out comes first: then the value of the rest is not used.
        group = sorted(self.groups[span], key=lambda change: change[1] is not None and change[0].kind != "state")
        start, closing = self.size, ""
        for m, new in group:
            if new == "":  # the declaration of a variable that is const because of m
                continue
            asks = "mutants::is_now" if m.place.in_constexpr else "mutants::is"
            if new is None:
                self.put(f"({asks}({m.n}) ? void() : void(")
            elif m.kind == "state":  # left out where this is true
                self.put(f"({asks}({m.n}) && ({new}) ? void() : void(")
            else:
                same = "bool(" if m.kind == "branch" and new in ("true", "false") else "("
                self.put(f"({asks}({m.n}) ? ({new}) : {same}")
            closing += "))"
        self.write_until(span[1], span[0])
        self.put(closing)
        self.parts += [(start, self.size, m) for m, _ in group]

    def owners(self, line, column):
        """The mutants that stand closest around a place of the new text."""
        at = self.line_starts[min(line, len(self.line_starts)) - 1] + column - 1
        around = [part for part in self.parts if part[0] <= at < part[1]]
        if not around:
            return []
        size = min(part[1] - part[0] for part in around)
        return [part[2] for part in around if part[1] - part[0] == size]

    def of_constants(self, line):
        """The mutants that change a constant whose name stands in a line of the new text."""
        named = set(re.findall(r"\w+", self.text.split("\n")[line - 1]))
        return [m for m in self.mutants if m.place.const_span and named & set(
            re.findall(r"(\w+)\s*[\[={(]", self.original[slice(*m.place.const_span)])[:1])]
