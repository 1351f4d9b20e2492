#!/usr/bin/env python3
"""One fact, one place: what a new thing of each kind touches, and what the compiler says of what was
forgotten.

usage: one_place_test.py SOURCE_DIR BUILD_DIR

To a scratch copy of the file where a kind is listed, a dummy is added, and nothing else; each other
file that must know of it is then compiled (no more than its syntax) and must not compile, in the
words that are given here. Counted are the files that a person edits or adds, documents and tests
aside. With GCC's words: exit code 77 with another compiler.
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile

from compile_commands import per_file

SKIPPED = 77
REGISTRY = "engine/dynamics/methods/registry.cpp"
NO_VISIT = r"no matching function for call to .*visit"
NOT_HANDLED = r"enumeration value .*dummy.* not handled in switch"


class Kind:
    """`edits`: (file, text, text with the dummy); `refused`: (file, what GCC says of it); `others`:
    what else a person writes, and no compiler can miss, or what `users` of it are refused for."""

    def __init__(self, name, edits, refused, others=(), users=()):
        self.name, self.edits, self.refused, self.others = name, edits, [*refused, *users], others
        self.users = {user[0] for user in users}

    def files(self):
        written = {e[0] for e in self.edits} | {r[0] for r in self.refused} | set(self.others)
        return sorted(written - self.users)


# How many files each may touch.
MOST = {"setting": 1, "quantity": 1, "command": 2, "part of a model": 2, "key": 3, "joint": 3,
        "shape": 5, "geometric shape": 8}

KINDS = [
    Kind("setting",
         [("engine/dynamics/settings.h", "    int gyroscopic_iterations = 3;\n",
           "    int gyroscopic_iterations = 3;\n    double dummy = 0;\n")],
         [("engine/dynamics/settings.h",
           "each member of StepSettings has a row in setting_rows")]),
    Kind("quantity",
         [("engine/scene/expect.cpp", "constexpr std::array all_quantities{\n",
           "constexpr std::array all_quantities{\n"
           '    QuantityInfo{"dummy", "m", "nothing says what it is"},\n')],
         [("engine/scene/expect.cpp", "could not convert|cannot convert|no matching function")]),
    Kind("command",
         [("engine/scene/command.h", "using Command = std::variant<",
           'struct Dummy {\n    static constexpr std::string_view name = "dummy";\n'
           "    template <typename Self, typename Visit> static void each_field(Self &, Visit &&) "
           "{}\n};\n\nusing Command = std::variant<Dummy, ")],
         [("engine/scene/real/world_simulation.cpp", "no matching function for call to .*obey")]),
    Kind("key",
         [("app/sandbox/keys.h", "    quit,\n", "    quit,\n    dummy,\n")],
         [("app/sandbox/keys.cpp", NOT_HANDLED), ("app/sandbox/sandbox.cpp", NOT_HANDLED)]),
    Kind("part of a model",
         [("app/lab/tune/plainer.h", "PART(shape)\n", "PART(shape) PART(dummy)\n")],
         [("app/lab/tune/plainer.cpp", NOT_HANDLED)]),
    Kind("joint",
         [("engine/dynamics/kinds.h", "JOINT(fixed)\n", "JOINT(fixed) JOINT(dummy)\n")],
         [("engine/scene/joint_type.cpp", NOT_HANDLED)],
         ["engine/dynamics/joints/kinds/dummy.cpp"]),
    Kind("shape",
         [("engine/scene/shape_desc.h", "using ShapeDesc = std::variant<",
           "struct DummyDesc {};\n\nusing ShapeDesc = std::variant<DummyDesc, ")],
         [("engine/scene/shape_desc.cpp", NO_VISIT),
          ("engine/scene/real/solid_shape.cpp", NO_VISIT),
          ("app/sandbox/draw/shape_draw.cpp", NO_VISIT)],
         ["engine/scene/shape_kinds.h"],
         [("engine/scene/file/shape.cpp", "incomplete type .*Kind<plumb::DummyDesc>")]),
    Kind("geometric shape",
         [("engine/geometry/shapes.h", "using Shape = std::variant<",
           "struct Dummy {};\n\nusing Shape = std::variant<Dummy, ")],
         [("engine/dynamics/bodies/solid.cpp", NO_VISIT),
          ("engine/geometry/mass.cpp", r"no matching function for call to .*mass_properties_of"),
          ("engine/geometry/manifold.cpp", "each two kinds of Shape need unchecked::collide"),
          ("engine/dynamics/contacts/approach.cpp", r"no matching function for call to .*distance"),
          ("engine/dynamics/contacts/inner_edges.cpp",
           r"no matching function for call to .*core_of"),
          ("engine/dynamics/contacts/surface_contact.cpp",
           r"no matching function for call to .*core_of"),
          ("engine/dynamics/hash.cpp", r"no matching function for call to .*add_shape")]),
]


def overlay(source, folder, edits):
    for file, before, after in edits:
        with open(os.path.join(source, file)) as stream:
            text = stream.read()
        if text.count(before) != 1:
            raise SystemExit(f"FAILED: {file} has not one {before!r}: this test is to be mended")
        path = os.path.join(folder, file)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as stream:
            stream.write(text.replace(before, after))


def compile_command(commands, source, folder, file):
    """Of that file, or of a header alone, with the scratch copies before all else."""
    like = file if file.endswith(".cpp") else re.sub(r"\.h$", ".cpp", file)
    arguments = shlex.split(commands[like])
    compiler, flags = arguments[0], arguments[1:]
    for option in ("-o", "-c"):
        at = flags.index(option)
        del flags[at:at + 2]
    copy = os.path.join(folder, like)
    return [compiler, "-I", folder, *flags, "-O0", "-fsyntax-only", "-fmax-errors=1",
            copy if os.path.exists(copy) else os.path.join(source, like)]


def check_scenes(source):
    """A scene is a file, and no other lists it."""
    print("scene: 1 file")
    lists = [os.path.join(source, "CMakeLists.txt")]
    for top in ("engine", "app"):
        for folder, _, files in os.walk(os.path.join(source, top)):
            lists += [os.path.join(folder, name) for name in files]
    failed = []
    for path in lists:
        with open(path) as stream:
            failed += [f"{path} names the scene {scene}"
                       for scene in re.findall(r"\w+\.toml", stream.read())]
    return failed


def check_linked(source, commands, build, kind, unit, edit, symbol):
    """A row of a list and a file with its function: of a row without a file the linker tells."""
    print(f"{kind}: 2 files")
    with tempfile.TemporaryDirectory(prefix="plumb-one-place-") as folder:
        overlay(source, folder, [edit])
        compiled = os.path.join(folder, "unit.o")
        command = compile_command(commands, source, folder, unit)
        command.remove("-fsyntax-only")
        subprocess.run([*command, "-c", "-o", compiled], cwd=build, check=True)
        said = subprocess.run([command[0], compiled], capture_output=True, text=True).stderr
        words = re.search(rf"undefined reference to .*::{symbol}\(.*'", said)
        print(f"    the linker: {words[0]}" if words else said)
        return [] if words else [f"{kind}: a row without a file links"]


def check_methods(source, commands, build):
    """Of a method's file without a row nothing else would tell."""
    with open(os.path.join(source, REGISTRY)) as stream:
        listed = set(re.findall(r"METHOD\((\w+)\)", stream.read()))
    failed = check_linked(source, commands, build, "method", REGISTRY,
                          (REGISTRY, "    METHOD(rk4)", "    METHOD(rk4) METHOD(dummy)"), "dummy")
    methods = os.path.dirname(os.path.join(source, REGISTRY))
    for name in sorted(os.listdir(methods)):
        if os.path.isdir(os.path.join(methods, name)):
            continue  # what several methods share
        with open(os.path.join(methods, name)) as stream:
            defined = re.findall(r"^Method (\w+)\(\) {", stream.read(), re.MULTILINE)
        if name != os.path.basename(REGISTRY) and not (defined and set(defined) <= listed):
            failed.append(f"{name} has no line in the registry")
    return failed


def check_panels(source, commands, build):
    return check_linked(
        source, commands, build, "panel", "app/sandbox/panels/ui.cpp",
        ("app/sandbox/panels/panels.h", "    PANEL(help, by_itself, help, false)",
         "    PANEL(help, by_itself, help, false) PANEL(dummy, left, world, true)"),
        "dummy_panel")


def main():
    source, build = (os.path.abspath(path) for path in sys.argv[1:3])
    entries = per_file(build)
    commands = {}
    for entry in entries:
        commands.setdefault(os.path.relpath(entry["file"], source), entry["command"])
    compiler = shlex.split(entries[0]["command"])[0]
    if "Free Software Foundation" not in subprocess.run(
            [compiler, "--version"], capture_output=True, text=True).stdout:
        print("skipped: the words are GCC's")
        return SKIPPED
    failed = check_scenes(source) + check_methods(source, commands, build)
    failed += check_panels(source, commands, build)
    for kind in KINDS:
        count = len(kind.files())
        print(f"{kind.name}: {count} file{'s' if count > 1 else ''}")
        if count > MOST[kind.name]:
            failed.append(f"{kind.name}: more than {MOST[kind.name]}")
        with tempfile.TemporaryDirectory(prefix="plumb-one-place-") as folder:
            overlay(source, folder, kind.edits)
            for file, words in kind.refused:
                done = subprocess.run(compile_command(commands, source, folder, file), cwd=build,
                                      capture_output=True, text=True,
                                      env={**os.environ, "LC_ALL": "C"})
                said = [line.split("error: ")[1] for line in done.stderr.splitlines()
                        if "error: " in line and re.search(words, line)]
                if done.returncode != 0 and said:
                    print(f"    {file}: {said[0]}")
                    continue
                failed.append(f"{kind.name}: {file} " + (
                    "compiles" if done.returncode == 0 else
                    f"says nothing like {words!r}:\n{done.stderr}"))
    for what in failed:
        print("FAILED: " + what)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
