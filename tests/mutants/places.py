"""Finds the places of a C++ file that a mutant can change, by the syntax tree of libclang."""

import re
import subprocess

from clang.cindex import CursorKind as Kind
from clang.cindex import Index, TypeKind

OPERATORS = {
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["/"],
    "&": ["|"], "|": ["&"], "^": ["|"], "<<": [">>"], ">>": ["<<"],
    "&&": ["||"], "||": ["&&"],
    "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="],
    "&=": ["|="], "|=": ["&="], "^=": ["|="], "<<=": [">>="], ">>=": ["<<="],
}
COMPARISONS = {
    "<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"],
    "==": ["!="], "!=": ["=="],
}
FUNCTIONS = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "sin": "cos", "cos": "sin",
             "lower_bound": "upper_bound", "upper_bound": "lower_bound"}
FUNCTION_KINDS = (Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR,
                  Kind.CONVERSION_FUNCTION, Kind.FUNCTION_TEMPLATE)
INTEGERS = (TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG,
            TypeKind.ULONGLONG, TypeKind.SHORT, TypeKind.USHORT, TypeKind.UCHAR, TypeKind.SCHAR)


class Place:
    """A place and the changes that can be made there. A change is a word for its kind and a list of
    edits (start, end, new text); those of one change are made together. A place in the initial
    value of a constexpr variable needs that variable to be only const: then `const_edit` is this
    edit and `const_span` the variable's declaration."""

    def __init__(self, path, line, span, changes):
        self.path, self.line, self.span, self.changes = path, line, span, changes
        self.in_constexpr = False
        self.const_edit = self.const_span = None


def flags():
    resources = subprocess.run(["clang", "-print-resource-dir"], capture_output=True, text=True).stdout
    return ["-std=c++20", "-march=native", "-I.", "-w", "-isystem", resources.strip() + "/include"]


def without_comments(text):
    text = re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda m: m[1] or " ", text, flags=re.S)
    return re.sub(r"\s+", " ", text).strip()


class Finder:
    def __init__(self, path, text):
        self.path, self.text, self.places = path, text, []
        self.constexpr_depth, self.variables = 0, []

    def add(self, cursor, changes):
        span = (cursor.extent.start.offset, cursor.extent.end.offset)
        if not changes or re.search(r"^\s*#", self.text[span[0]:span[1]], flags=re.M):
            return
        place = Place(self.path, cursor.extent.start.line, span, changes)
        place.in_constexpr = self.constexpr_depth > 0
        if self.variables:
            place.const_edit, place.const_span = self.variables[-1]
        self.places.append(place)

    def of(self, cursor):
        """The text of a node, without comments and on one line."""
        return without_comments(self.text[cursor.extent.start.offset:cursor.extent.end.offset])

    def is_here(self, cursor):
        start, end = cursor.extent.start, cursor.extent.end
        return (start.file and start.file.name == self.path and end.file
                and end.file.name == self.path and start.offset < end.offset)

    def walk(self, cursor, parent=None):
        if not self.is_here(cursor) or cursor.kind in (Kind.STATIC_ASSERT, Kind.ENUM_DECL):
            return
        self.look(cursor, parent)
        head = self.text[cursor.extent.start.offset:cursor.extent.end.offset].split("{")[0]
        is_constexpr = re.search(r"\b(constexpr|consteval)\b", head)
        in_function = cursor.kind in FUNCTION_KINDS and is_constexpr
        in_variable = cursor.kind == Kind.VAR_DECL and re.search(r"\bconstexpr\b", head.split("=")[0])
        self.constexpr_depth += bool(in_function)
        if in_variable:
            at = cursor.extent.start.offset + head.index("constexpr")
            in_class = cursor.semantic_parent and cursor.semantic_parent.kind in (
                Kind.STRUCT_DECL, Kind.CLASS_DECL, Kind.CLASS_TEMPLATE)
            edit = (at, at + len("constexpr"), "inline const" if in_class else "const")
            self.variables.append((edit, (cursor.extent.start.offset, cursor.extent.end.offset)))
        for child in cursor.get_children():
            self.walk(child, cursor)
        if in_variable:
            self.variables.pop()
        self.constexpr_depth -= bool(in_function)

    def look(self, cursor, parent):
        kind = cursor.kind
        children = [c for c in cursor.get_children() if self.is_here(c)]
        text = self.of(cursor)
        if kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR) and len(children) == 2:
            self.binary(cursor, children[0], children[1])
        elif kind == Kind.CALL_EXPR and cursor.spelling.startswith("operator") and len(children) >= 2:
            if cursor.spelling == "operator[]":
                self.index(cursor, children[0], children[-1])
            elif self.of(children[0]).startswith("-"):
                pass
            elif text.startswith("-") and len(children) == 2 and not self.of(children[1]).startswith("-"):
                self.add(cursor, [("sign", [self.edit(cursor, text[1:])])])
            else:
                self.binary(cursor, children[0], children[-1])
        elif kind == Kind.ARRAY_SUBSCRIPT_EXPR and len(children) == 2:
            self.index(cursor, *children)
        elif kind == Kind.UNARY_OPERATOR and text[:2] in ("++", "--"):
            new = ("--" if text[0] == "+" else "++") + text[2:]
            self.add(cursor, [("operator", [self.edit(cursor, new)])])
        elif kind == Kind.UNARY_OPERATOR and text[0] in "-!":
            new = ("sign", text[1:]) if text[0] == "-" else ("branch", f"bool({text[1:]})")
            self.add(cursor, [(new[0], [self.edit(cursor, new[1])])])
        elif kind == Kind.INTEGER_LITERAL and re.fullmatch(r"(0x[\da-fA-F']+|0b[01']+|[\d']+)[uUlLzZ]*", text):
            changes = [f"({text} + 1)"] + ([f"({text} - 1)"] if not re.fullmatch("0+[uUlL]*", text) else [])
            self.add(cursor, [("constant", [self.edit(cursor, c)]) for c in changes])
        elif kind == Kind.FLOATING_LITERAL and re.fullmatch(r"(0x)?[\d.][\da-fA-F.']*([eEpP][+-]?\d+)?[fF]?", text):
            zero = float.fromhex(text.rstrip("fF")) == 0 if "0x" in text else float(text.rstrip("fF")) == 0
            suffix = "f" if text[-1] in "fF" and "0x" not in text or "0x" in text and "p" in text and text[-1] == "f" else ""
            changes = ["1.0" + suffix] if zero else [f"(2 * {text})", "0.0" + suffix]
            self.add(cursor, [("constant", [self.edit(cursor, c)]) for c in changes])
        elif kind == Kind.CXX_BOOL_LITERAL_EXPR and text in ("true", "false"):
            self.add(cursor, [("constant", [self.edit(cursor, "true" if text == "false" else "false")])])
        elif kind == Kind.MEMBER_REF_EXPR:
            self.member(cursor, text)
        elif kind == Kind.CALL_EXPR:
            self.call(cursor, children, text)
        elif kind == Kind.INIT_LIST_EXPR:
            self.swaps(children)
        elif kind in (Kind.IF_STMT, Kind.WHILE_STMT, Kind.CONDITIONAL_OPERATOR):
            self.branch(cursor, children)
        if parent is not None and self.is_statement(cursor, parent):
            self.add(cursor, [("statement", [self.edit(cursor, None)])])

    def edit(self, cursor, text):
        return (cursor.extent.start.offset, cursor.extent.end.offset, text)

    def binary(self, cursor, left, right):
        between = self.text[left.extent.end.offset:right.extent.start.offset]
        operator = without_comments(between)
        a, b = self.of(left), self.of(right)
        changes = []
        if operator in OPERATORS:
            changes = [("operator", f"{a} {o} {b}") for o in OPERATORS[operator]]
            if operator in ("+", "-", "*", "/", "&&", "||"):
                changes.append(("operator", a))
            if operator in ("+", "*", "&&", "||"):
                changes.append(("operator", b))
        elif operator in COMPARISONS:
            changes = [("comparison", f"{a} {o} {b}") for o in COMPARISONS[operator]]
        self.add(cursor, [(kind, [self.edit(cursor, new)]) for kind, new in changes])

    def index(self, cursor, array, at):
        if at.type.get_canonical().kind not in INTEGERS:
            return
        i = self.of(at)
        self.add(at, [("index", [self.edit(at, f"{i} > 0 ? {i} - 1 : 0")])])

    def member(self, cursor, text):
        """Another field of the same type in place of the one that is named."""
        field = cursor.referenced
        if field is None or field.kind != Kind.FIELD_DECL or not re.search(r"(\.|->)\w+$", text):
            return
        type_ = field.type.get_canonical().spelling
        others = [f.spelling for f in field.semantic_parent.get_children()
                  if f.kind == Kind.FIELD_DECL and f.spelling and f.spelling != field.spelling
                  and f.type.get_canonical().spelling == type_]
        base = text[:len(text) - len(field.spelling)]
        if text.endswith(field.spelling):
            self.add(cursor, [("index", [self.edit(cursor, base + other)]) for other in others[:3]])

    def call(self, cursor, children, text):
        match = re.match(r"(std::)?(\w+)\(", text)
        if match and match[2] in FUNCTIONS and (match[1] or match[2] in ("min", "max")):
            new = (match[1] or "") + FUNCTIONS[match[2]] + text[match.end() - 1:]
            self.add(cursor, [("operator", [self.edit(cursor, new)])])
        self.swaps([c for c in cursor.get_arguments() if c is not None and self.is_here(c)])

    def swaps(self, arguments):
        """Two neighbours of the same small type change places."""
        for a, b in zip(arguments, arguments[1:]):
            type_ = a.type.get_canonical()
            if (type_.spelling.replace("const ", "") != b.type.get_canonical().spelling.replace("const ", "")
                    or not 0 < type_.get_size() <= 32 or not type_.is_pod()
                    or "lambda" in type_.spelling or "{" in self.of(a) + self.of(b)
                    or self.of(a) == self.of(b)):
                continue
            self.add(a, [("argument", [self.edit(a, self.of(b)), self.edit(b, self.of(a))])])

    def branch(self, cursor, children):
        conditions = [c for c in children if c.kind.is_expression()]
        if not conditions or children[0].kind == Kind.VAR_DECL:
            return
        condition = conditions[0]
        head = self.text[cursor.extent.start.offset:condition.extent.start.offset]
        if "constexpr" in head:
            return
        ways = ["false"] if cursor.kind == Kind.WHILE_STMT else ["false", "true"]
        self.add(condition, [("branch", [self.edit(condition, way)]) for way in ways])

    def is_statement(self, cursor, parent):
        if not cursor.kind.is_expression() or cursor.kind in (Kind.LAMBDA_EXPR,):
            return False
        if parent.kind == Kind.COMPOUND_STMT:
            return True
        children = list(parent.get_children())
        if parent.kind == Kind.IF_STMT:
            return any(cursor == c for c in children[1:]) and self.text[
                cursor.extent.end.offset:cursor.extent.end.offset + 1] == ";"
        return parent.kind in (Kind.FOR_STMT, Kind.CXX_FOR_RANGE_STMT) and cursor == children[-1]


def places_of(path, flags_):
    """All places of a header or source, in the order in which they stand."""
    with open(path, encoding="latin-1", newline="") as file:
        text = file.read()
    index = Index.create()
    if path.endswith(".h"):
        unit = index.parse("mutants.cpp", flags_, unsaved_files=[("mutants.cpp", f'#include "{path}"\n')])
    else:
        unit = index.parse(path, flags_)
    errors = [d for d in unit.diagnostics if d.severity >= 3]
    finder = Finder(path, text)
    for cursor in unit.cursor.get_children():
        name = cursor.location.file.name if cursor.location.file else ""
        if name in (path, "./" + path):
            finder.path = name
            finder.walk(cursor)
    for place in finder.places:
        place.path = path
    return finder.places, [str(e) for e in errors]
