"""What a student's file may contain so that make grade compiles it. chapters/COURSE.md says it in words."""
import os
import re

TOKEN = re.compile(
    r"""//[^\n]*|/\*.*?\*/ |                        # comments
        "(?:[^"\\\n]|\\.)*" |                        # strings
        \.?[0-9](?:[eEpP][+-]|'?[\w.])* |            # numbers
        [A-Za-z_]\w* |                               # words
        '(?:[^'\\\n]|\\.)*' |                        # characters
        %: | \S""", re.S | re.X)
HEADERS = set("""algorithm array atomic bit cassert cfloat climits cmath complex concepts cstddef cstdint cstdio
    cstdlib cstring deque functional initializer_list iomanip iostream iterator limits list map memory numbers numeric
    optional ostream queue random ranges set span sstream stack stdexcept string string_view tuple type_traits
    unordered_map unordered_set utility variant vector""".split())
# What ends the program, reaches files, processes and other programs, or what decides on claims.
WORDS = set("""abort alarm asm at_quick_exit atexit basic_filebuf basic_fstream basic_ifstream basic_ofstream cin creat
    dlopen dlsym doctest dprintf dup dup2 environ exit extern fcntl fdopen filebuf fileno filesystem fopen freopen
    fork fstream getenv gnu ifstream import ioctl longjmp mmap module mprotect ofstream open openat popen pread ptrace
    pwrite quick_exit raise read readv reinterpret_cast set_terminate setjmp sigaction signal stdin syscall system terminate vdprintf vfork
    write writev""".split())


def may_include(header, number):
    """Whether it is a header of common/ that neither this chapter nor a later one teaches."""
    if not header.startswith("common/") or ".." in header or not os.path.isfile(header):
        return False
    with open(header) as file:
        found = re.search(r"taught by chapter (\d\d)", file.readline())
    return not found or found.group(1) < number


def is_directive(line, number):
    include = re.fullmatch(r'\s*#\s*include\s*(?:<(\w+)>|"([\w./]+)")\s*(?://.*)?', line)
    if include:
        return include.group(1) in HEADERS if include.group(1) else may_include(include.group(2), number)
    return re.fullmatch(r"\s*#\s*pragma\s+once\s*(?://.*)?", line)


def objection(text, number, own):
    """The first thing that a file may not contain, with its line, or None. `own`: the chapter's own file."""
    lines, kept = text.split("\n"), set(own.split("\n"))
    for n, line in enumerate(lines, 1):
        if line.endswith("\\") or "??" in line:
            return f"line {n}: a backslash at the end, or ??"
    tokens = [(m.group(), text.count("\n", 0, m.start()) + 1) for m in TOKEN.finditer(text)]
    tokens = [(token, n) for token, n in tokens if not token.startswith(("//", "/*"))]
    depth, opened, directive = 0, [], 0
    for i, (token, n) in enumerate(tokens):
        after = tokens[i + 1][0] if i + 1 < len(tokens) else ""
        if token in ("#", "%:"):
            directive = n
            if lines[n - 1] not in kept and not is_directive(lines[n - 1], number):
                return f"line {n}: {lines[n - 1].strip()}"
        if n == directive:
            continue
        if token in WORDS or "__" in token or re.match(r"_|exec[lv]p?e?$|pthread|posix_", token):
            if lines[n - 1] not in kept and not token.startswith(('"', "'")):
                return f"line {n}: the word {token}"
        if re.fullmatch(r"(u8|u|U|L)?R", token) and after.startswith('"'):
            return f"line {n}: a raw string"
        if depth == 0:
            opened = opened + [token]
            if opened != ["namespace", f"ch{number}", "{"][:len(opened)]:
                return f"line {n}: {token} outside of namespace ch{number}"
        elif token == "namespace" and after != "{" and tokens[i - 1][0] != "using":
            return f"line {n}: another namespace"
        depth += (token == "{") - (token == "}")
        if token == "}" and depth == 0:
            opened = []
    return None
