"""What a source file keeps to itself (in an unnamed namespace, outside of classes and functions) has a name that no other
source file of the same folder takes: files are compiled together, and which ones differs between builds, so that a name
taken twice breaks one build and not another. Functions may overload each other. Nor do tests take the name of a function
of their support, which it would hide from the others, nor two headers the same name for a type, of which the linker would
keep the functions of one. Prints every name taken twice."""

import collections
import pathlib
import re
import sys

FOLDERS = ["core", "linsolve", "formulations", "integrators", "app", "bench/study", "bench/records", "bench/view",
           "bench/cases", "bench/stability", "bench/paper", "bench/report", "tests"]
FUNCTION = re.compile(r"^(?!return|using|template)[\w:<>,*& ]+?[ *&](\w+)\(([^()]*(?:\([^()]*\)[^()]*)*)\)[^;]*\{")
CONSTANT = re.compile(r"^(?:inline |static )*(?:constexpr|const) [\w:<>,*& ]+?[ *&](\w+)(?:\[\w*\])? ?[={]")
NEXT_CONSTANT = re.compile(r", (k\w+) = ")
SHARED = re.compile(r"^(?:inline|template <.*>) ?[\w:<>,*& ]*?[ *&](\w+)\(", re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class|enum) (\w+)\b[^;]*\{?$")


def parameters(text):
    """The types of a list of parameters, without their names."""
    parts, depth, part = [], 0, ""
    for letter in text + ",":
        if letter == "," and depth == 0:
            parts.append(re.sub(r"\s*=.*$", "", part).strip())
            part = ""
            continue
        depth += letter in "<(" and 1 or letter in ">)" and -1 or 0
        part += letter
    return tuple(re.sub(r"([ *&])\w+$", r"\1", part).strip() for part in parts)


def local_names(text):
    """(name, parameters or nothing, line) of what stands at the left margin in an unnamed namespace."""
    inside, named, joined, first = False, "", "", 0
    for number, line in enumerate(text.splitlines(), 1):
        if line == "namespace {":
            inside = True
        elif line == "}  // namespace":
            inside = False
        elif inside and re.match(r"namespace \w+ \{", line):  # what stands in one of these has its own name
            named = line
        elif named and line.startswith("}  // namespace "):
            named = ""
        if not inside or named:
            continue
        if joined:  # a head that goes on
            joined += " " + line.strip()
        elif re.match(r"[A-Za-z]", line):
            joined, first = line, number
        if not joined:
            continue
        for form in (FUNCTION, CONSTANT, TYPE):
            found = form.match(joined)
            if found:
                yield found[1], parameters(found[2]) if form is FUNCTION else None, first
                if form is CONSTANT:
                    yield from ((name, None, first) for name in NEXT_CONSTANT.findall(line))
                joined = ""
                break
        if "{" in joined or joined.rstrip().endswith(";"):
            joined = ""


def taken_twice(root):
    for folder in FOLDERS:
        places = collections.defaultdict(list)
        for path in sorted((root / folder).rglob("*.cpp")):
            for name, of, line in local_names(path.read_text(encoding="utf-8")):
                places[name, of].append(f"{path.relative_to(root).as_posix()}:{line}")
        for (name, _), where in sorted(places.items(), key=lambda item: item[1]):
            if len({place.split(":")[0] for place in where}) > 1:
                yield f"{name}: {', '.join(where)}"


def hiding_support(root):
    shared = collections.defaultdict(list)
    for path in sorted((root / "tests/support").glob("*.h")):
        for name in SHARED.findall(path.read_text(encoding="utf-8")):
            shared[name].append(path.relative_to(root).as_posix())
    for path in sorted((root / "tests").glob("*.cpp")):
        for name, of, line in local_names(path.read_text(encoding="utf-8")):
            if of is not None and name in shared:
                yield f"{name}: {path.relative_to(root).as_posix()}:{line} hides that of {shared[name][0]}"


def types_of_headers(root):
    places = collections.defaultdict(list)
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.h")):
            within = []
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                if opened := re.match(r"namespace ([\w:]+) \{", line):
                    within.append(opened[1])
                elif line.startswith("}  // namespace"):
                    within.pop()
                elif (found := TYPE.match(line)) and "{" in line:
                    name = "::".join([*within, found[1]])
                    places[name].append(f"{path.relative_to(root).as_posix()}:{number}")
    for name, where in sorted(places.items()):
        if len(where) > 1:
            yield f"{name}: {', '.join(where)}"


def main():
    root = pathlib.Path(sys.argv[1])
    sample = "namespace {\n\nconstexpr double kOne = 1;\nstruct A {\n  int kInner = 2;\n};\n" \
             "double f(const A& a,\n         int b) {\n}\n}  // namespace\nvoid g() {\n}\n"
    assert [name[:2] for name in local_names(sample)] == [("kOne", None), ("A", None), ("f", ("const A&", "int"))]
    assert SHARED.findall("inline Settings controlled(int a) {\n") == ["controlled"]
    found = list(taken_twice(root)) + list(hiding_support(root)) + list(types_of_headers(root))
    for line in found:
        print(line)
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
