"""Makes mistakes of a student's kind from the solution of a chapter, each with its label."""

import glob
import os
import random
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, "tests/mutants")
import places
import schemata
from clang.cindex import CursorKind as Kind
from clang.cindex import Index

# The kinds of which no hypothesis is made: they show what make check says of kinds that it does not know.
HELD_OUT = ("argument", "comparison", "index")


class Finder(places.Finder):
    """The places of `make mutants`, each with its function, and the updates of what a loop carries."""

    def __init__(self, path, text):
        super().__init__(path, text)
        self.functions, self.parts, self.loops, self.of_min_or_max = [], [], [], False

    def add(self, cursor, changes):
        count = len(self.places)
        line = self.text[self.text.rfind("\n", 0, cursor.extent.start.offset) + 1:cursor.extent.start.offset]
        if not line.strip().startswith("recorder."):  # what is recorded is no light
            super().add(cursor, changes)
        for place in self.places[count:]:
            place.function = self.functions[-1] if self.functions else ""
            place.part = self.parts[0] if self.parts else ""
            place.state = ""

    def walk(self, cursor, parent=None):
        is_function = cursor.kind in places.FUNCTION_KINDS
        is_loop = cursor.kind in (Kind.FOR_STMT, Kind.WHILE_STMT) and len(self.functions) == 1
        if is_function:
            parent = cursor.semantic_parent
            self.functions.append(cursor.spelling)
            self.parts.append(parent.spelling if parent.kind in (Kind.STRUCT_DECL, Kind.CLASS_DECL) else cursor.spelling)
        if is_loop:
            self.loops.append(cursor.extent.start.offset)
        super().walk(cursor, parent)
        if is_function:
            self.functions.pop()
            self.parts.pop()
        if is_loop:
            self.loops.pop()

    def look(self, cursor, parent):
        if not self.of(cursor).startswith("recorder."):
            super().look(cursor, parent)
        if self.loops and self.functions[0].startswith("trace"):
            self.update(cursor)

    def swaps(self, arguments):
        if not self.of_min_or_max:  # where the order makes no difference
            super().swaps(arguments)

    def call(self, cursor, children, text):
        self.of_min_or_max = text.startswith(("std::min(", "std::max("))
        super().call(cursor, children, text)
        self.of_min_or_max = False

    def update(self, cursor):
        """A variable from before the loop that gets a new value in it: never, at the first vertex
        only, or at all but the first."""
        children = [c for c in cursor.get_children() if self.is_here(c)]
        if len(children) < 2 or cursor.kind not in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR,
                                                    Kind.CALL_EXPR):
            return
        between = self.text[children[0].extent.end.offset:children[-1].extent.start.offset]
        variable = children[0].referenced if children[0].kind == Kind.DECL_REF_EXPR else None
        if (variable is None or places.without_comments(between) not in ("=", "*=", "/=")
                or variable.location.offset > self.loops[0]):
            return
        first = "depth > 1" if "depth = 1" in self.text else "depth > 0"
        count = len(self.places)
        self.add(cursor, [("state", [self.edit(cursor, c)]) for c in ("true", first, f"!({first})")])
        for place in self.places[count:]:
            place.state = variable.spelling


def find(path):
    with open(path, encoding="latin-1", newline="") as file:
        text = file.read()
    unit = Index.create().parse("mistakes.cpp", places.flags(),
                                unsaved_files=[("mistakes.cpp", f'#include "{path}"\n')])
    finder = Finder(path, text)
    for cursor in unit.cursor.get_children():
        if cursor.location.file and cursor.location.file.name in (path, "./" + path):
            finder.path = cursor.location.file.name
            finder.walk(cursor)
    for place in finder.places:
        place.path = path
    return finder.places, text


def label(m, text):
    """What a mistake is, in words."""
    def short(s):
        s = places.without_comments(s).replace("\t", " ")
        return s if len(s) < 90 else s[:80] + " ..."

    if m.kind == "state":
        start, end, condition = m.edits[0]
        words = ("is never {}" if condition == "true" else
                 "is {} after the first vertex only" if condition.startswith("!") else "is {} at the first vertex only")
        # A division, such as by the probability of roulette, is not what most people call an update.
        if "/=" in text[start:end]:
            return f"`{short(text[start:end])}` " + words.format("done")
        return f"`{m.place.state}` " + words.format("updated")
    old = [short(text[start:end]) for start, end, _ in m.edits]
    if m.edits[0][2] is None:
        return f"`{old[0]}` is missing"
    if m.kind == "argument":
        return f"`{old[0]}` and `{old[1]}` are exchanged"
    if m.kind == "branch" and m.edits[0][2] in ("true", "false"):
        return f"`{old[0]}` is always {m.edits[0][2]}"
    return f"`{short(m.edits[0][2])}` stands where `{old[0]}` belongs"


def draw(path, n, seed, predicts):
    """n places of a chapter, all kinds alike; to predict, also n states. Numbers stay the same for a seed."""
    found, text = find(path)
    dice = random.Random(f"{seed} {path}")
    by_kind = {}
    for place in found:
        if not place.function:
            continue
        if place.state:
            for kind, edits in place.changes:
                by_kind.setdefault("state", []).append((place, kind, edits))
        else:
            kind, edits = dice.choice(place.changes)
            by_kind.setdefault(kind, []).append((place, kind, edits))
    states = by_kind.get("state", [])
    dice.shuffle(states)
    chosen = states[:n] if predicts else []
    if predicts:
        by_kind.pop("state", None)
    for options in by_kind.values():
        dice.shuffle(options)
    count = 0
    while count < n and any(by_kind.values()):
        for kind in sorted(by_kind):
            if by_kind[kind] and count < n:
                chosen.append(by_kind[kind].pop())
                count += 1
    mistakes = [schemata.Mutant(i + 1, path, *c) for i, c in enumerate(chosen)]
    for m in mistakes:
        m.label = label(m, text)
    return mistakes, text


def with_mistake(text, m):
    """The text of a chapter with one mistake."""
    for start, end, new in sorted(m.edits, reverse=True):
        old = text[start:end]
        if m.kind == "state":
            new = f"(({new}) ? void() : void({old}))"
        text = text[:start] + ("void()" if new is None else f"({new})") + text[end:]
    return text


def renamed(path, text):
    """The text with other names for all variables of functions, so that none is the chapter's letter for letter."""
    unit = Index.create().parse("mistakes.cpp", places.flags(),
                                unsaved_files=[("mistakes.cpp", f'#include "{path}"\n'), (path, text)])
    ends, functions = set(), places.FUNCTION_KINDS + (Kind.LAMBDA_EXPR,)

    def is_local(variable):
        return (variable and variable.kind in (Kind.VAR_DECL, Kind.PARM_DECL) and variable.spelling
                and variable.location.file and variable.location.file.name.endswith(path)
                and variable.semantic_parent and variable.semantic_parent.kind in functions)

    def walk(cursor):
        if cursor.location.file and cursor.location.file.name.endswith(path):
            variable = cursor if is_local(cursor) else cursor.referenced
            if cursor.kind in (Kind.VAR_DECL, Kind.PARM_DECL, Kind.DECL_REF_EXPR, Kind.VARIABLE_REF) and is_local(variable):
                start, name = cursor.location.offset, variable.spelling
                if text[start:start + len(name)] == name:
                    ends.add(start + len(name))
        for child in cursor.get_children():
            walk(child)
    for cursor in unit.cursor.get_children():
        walk(cursor)
    for end in sorted(ends, reverse=True):
        text = text[:end] + "_here" + text[end:]
    return text


class Program:
    """The pictures, or the tests, of a chapter with all its mistakes in one program."""

    def __init__(self, build, chapter, n, seed, predicts, compiler):
        self.folder, self.number = f"{build}/mistakes/{chapter}", chapter
        self.path = glob.glob(f"chapters/{chapter}_*/estimator.h")[0]
        self.mistakes, self.text = draw(self.path, n, seed, predicts)
        self.compiler, self.build_folder, self.wanted = compiler, build, n
        self.source = f"tests/measure/method_{chapter}.cpp"
        if not os.path.exists(self.source):
            self.source = f"tests/chapters/ch{chapter}.cpp"
        self.dropped = set()
        os.makedirs(os.path.dirname(f"{self.folder}/{self.path}"), exist_ok=True)
        self.common = [o for o in glob.glob(f"{build}/obj/common/*/*.o")
                       if "/tools/" not in o and os.path.exists(o.split("/obj/", 1)[1][:-1] + "cpp")]
        self.flags = compiler + ["-O1", "-w", "-Wno-narrowing", "-include", "tests/mutants/chosen.h",
                                 f"-I{self.folder}", "-I."]
        self.drop_what_does_not_compile()

    def write(self):
        kept = [m for m in self.mistakes if m.n not in self.dropped]
        self.written = schemata.Written(self.text, kept)
        with open(f"{self.folder}/{self.path}", "w", encoding="latin-1", newline="") as file:
            file.write(self.written.text)

    def drop_what_does_not_compile(self):
        import re
        while True:
            self.write()
            done = subprocess.run(self.flags + ["-fdiagnostics-column-unit=byte", "-fsyntax-only",
                                                self.source],
                                  capture_output=True, text=True)
            if done.returncode == 0:
                break
            before, pending = len(self.dropped), False
            for path, line, column, what in re.findall(r"^(\S+?):(\d+):(\d+): (?:fatal )?(error|note):",
                                                       done.stderr, flags=re.M):
                owners = self.written.owners(int(line), int(column)) if path.endswith(self.path) else []
                if what == "error" or pending:
                    # Where several change the same words, those that leave nothing out are tried first.
                    changing = [m for m in owners if m.kind not in ("state", "statement")]
                    self.dropped |= {m.n for m in changing or owners}
                    pending = not owners
            if len(self.dropped) == before:
                sys.exit(f"error: {self.path} with mistakes does not compile:\n{done.stderr[:2000]}")
        self.mistakes = [m for m in self.mistakes if m.n not in self.dropped]

    def compiles(self, path):
        """Whether a file compiles in place of the chapter's."""
        shutil.copy(path, f"{self.folder}/{self.path}")
        return subprocess.run(self.flags + ["-fsyntax-only", self.source], capture_output=True).returncode == 0

    def build(self, name, source, objects):
        """Compiles and links one program; None if that fails."""
        to = f"{self.folder}/{name}"
        steps = [self.flags + ["-c", source, "-o", to + ".o"],
                 self.flags + ["-x", "c++", "-c", "tests/mutants/chosen.cc", "-o", f"{self.folder}/chosen.o"],
                 self.compiler + [to + ".o", f"{self.folder}/chosen.o", *objects, *self.common, "-o", to]]
        for step in steps:
            done = subprocess.run(step, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"error: {source} does not compile with mistakes:\n{done.stderr[:2000]}")
        return to

    def pictures(self):
        b = self.build_folder
        return self.build("names", self.source,
                          glob.glob(f"{b}/obj/tests/check/*.o")
                          + [f"{b}/obj/tests/measure/methods.o", f"{b}/obj/tests/measure/measure.o"])
