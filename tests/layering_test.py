#!/usr/bin/env python3
"""Who may include whom, checked over all sources.

layering_test.py ROOT         checks the tree at ROOT
layering_test.py --self-test  checks that each rule fails on a tree in which it is broken
"""

import pathlib
import re
import sys

# Each room may include itself and what stands before it.
ENGINE_ROOMS = ["core", "math", "geometry", "space", "dynamics", "scene"]
APP_ROOMS = ["files", "render", "lab", "sandbox"]

# A library known to few files: header pattern, the files that may include it, and how many at most.
LIBRARIES = [
    (r"toml\+\+/|toml\.hpp", r"engine/scene/file/table\.h", 1),
    (r"tiny_obj_loader", r"engine/scene/[^/]+\.cpp", 1),
    (r"hwy/", r"engine/(geometry|space)/[^/]+|engine/math/(wide_vector|four)-inl\.h"
     r"|engine/dynamics/(columns-inl\.h|\w+/(contact|flight|front|joint|spring)_kernels\.cpp)|"
     r"tests/(geometry|space|dynamics)/[^/]+", None),
    (r"Eigen/", r"engine/math/sparse_cholesky\.cpp", 1),
    (r"benchmark/", r"app/lab/timing\.cpp", 1),
    (r"Bullet|LinearMath/|fcl/|embree|\bode/|btBullet",
     r"tests/bench/[^/]+|app/lab/engines/engine_(bullet|ode)\.cpp", None),
    (r"GLFW/", r"app/render/window_context\.cpp|app/sandbox/(\w+/)?[^/]+\.cpp", 3),
    (r"GL/osmesa\.h", r"app/render/[^/]+\.cpp", 1),
    (r"glad/|GL/", r"app/render/[^/]+", None),
    (r"imgui|backends/imgui", r"app/render/(imgui_renderer|fonts)[^/]*|app/sandbox/(\w+/)?[^/]+"
                              r"|app/lab/chart/[^/]+|tests/(render|sandbox|app)/[^/]+", None),
    (r"stb_|stb/", r"app/render/[^/]+\.cpp", None),
    (r"CLI/", r"app/main\.cpp|app/[^/]+\.(cpp|h)", None),
]

# The lab opens no window: nothing of it names what does.
NO_WINDOW = re.compile(r"\b(GLFW|glfw)\w*|\bcreate_window_context\b|\bGlChoice::(window|automatic)")

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/', re.DOTALL)


def room_of(path):
    """engine/scene/real/x.h -> ("engine", "scene"); app/main.cpp -> ("app", "")."""
    parts = path.split("/")
    return parts[0], parts[1] if len(parts) > 2 else ""


def may_include(includer, included):
    """Whether a file may include another of ours, by their rooms; None for yes, else the reason."""
    house, room = room_of(includer)
    to_house, to_room = room_of(included)
    if to_house == "tests":
        return None if house == "tests" else "only tests include tests"
    if house == "tests":
        return None
    if house == "engine":
        if to_house != "engine":
            return "the engine knows nothing of the app"
        if not room:
            return None  # engine/plumb.h gathers all
        if not to_room:
            return "engine/plumb.h is for users of the engine"
        if room not in ENGINE_ROOMS:
            return f"unknown room engine/{room}"
        if to_room not in ENGINE_ROOMS[: ENGINE_ROOMS.index(room) + 1]:
            return f"{room} comes before {to_room}"
        return None
    if to_house == "engine" or not room:
        return None
    if room not in APP_ROOMS:
        return f"unknown room app/{room}"
    if to_room not in APP_ROOMS[: APP_ROOMS.index(room) + 1]:
        return f"app/{room} may not know app/{to_room}"
    return None


def cycles(graph):
    """One message for each include that closes a circle."""
    found, state = [], {}

    def visit(file, path):
        state[file] = "open"
        for target in graph.get(file, []):
            if state.get(target) == "open":
                circle = path[path.index(target):] + [target]
                found.append(f"{file}: includes form a circle: {' -> '.join(circle)}")
            elif target not in state:
                visit(target, path + [target])
        state[file] = "done"

    for file in sorted(graph):
        if file not in state:
            visit(file, [file])
    return found


def check(tree):
    """All violations in a tree, given as {path from the root: text}."""
    found, graph = [], {}
    users = {pattern: [] for pattern, _, _ in LIBRARIES}
    for path in sorted(tree):
        graph[path] = []
        for match in INCLUDE.finditer(tree[path]):
            ours, system = match.groups()
            line = tree[path].count("\n", 0, match.start(1 if ours else 2)) + 1
            if ours and ours not in tree:
                found.append(f'{path}:{line}: "{ours}" is no file of ours, named from the root')
            elif ours:
                graph[path].append(ours)
                reason = may_include(path, ours)
                if reason:
                    found.append(f"{path}:{line}: may not include {ours}: {reason}")
            for pattern, allowed, _ in LIBRARIES:
                if system and re.match(pattern, system):
                    users[pattern].append(path)
                    if not re.fullmatch(allowed, path):
                        found.append(f"{path}:{line}: <{system}> is not for this file")
                    break
        if path.startswith("app/lab/"):
            for match in NO_WINDOW.finditer(COMMENT.sub("", tree[path])):
                found.append(f"{path}: the lab opens no window, but names {match.group()}")
        own = path[: -len(".cpp")] + ".h"
        if path.endswith(".cpp") and own in tree and graph[path][:1] != [own]:
            found.append(f"{path}: includes {own} not first, so nothing shows that it stands alone")
        # Highway includes a -inl.h once for each instruction set.
        if path.endswith(".h") and not path.endswith("-inl.h") and "#pragma once" not in tree[path]:
            found.append(f"{path}: has no #pragma once")
    for pattern, _, most in LIBRARIES:
        files = sorted(set(users[pattern]))
        if most is not None and len(files) > most:
            found.append(f"<{pattern}> is included by more than {most}: {', '.join(files)}")
    return found + cycles(graph)


def read_tree(root):
    root = pathlib.Path(root)
    return {
        str(file.relative_to(root)): file.read_text(encoding="utf-8")
        for house in ("engine", "app", "tests")
        for file in (root / house).rglob("*")
        if file.suffix in (".h", ".cpp", ".inc") and "tests/install" not in str(file)
    }


# A small tree without a fault, and what breaks each rule in turn: file, text, part of the message.
SOUND = {
    "engine/plumb.h": '#pragma once\n#include "engine/scene/simulation.h"\n',
    "engine/core/check.h": "#pragma once\n#include <string>\n",
    "engine/math/types.h": '#pragma once\n#include "engine/core/check.h"\n',
    "engine/geometry/shapes.h": '#pragma once\n#include "engine/math/types.h"\n',
    "engine/space/tree.h": '#pragma once\n#include "engine/geometry/shapes.h"\n',
    "engine/dynamics/world.h": '#pragma once\n#include "engine/space/tree.h"\n',
    "engine/scene/simulation.h": '#pragma once\n#include "engine/dynamics/world.h"\n',
    "engine/scene/file/table.h": "#pragma once\n#include <toml++/toml.h>\n",
    "app/render/renderer.h": '#pragma once\n#include "engine/plumb.h"\n',
    "app/render/window_context.cpp": "#include <GLFW/glfw3.h>\n",
    "app/render/osmesa_context.cpp": "#include <glad/gl.h>\n#include <GL/osmesa.h>\n",
    "app/lab/sweep.h": '#pragma once\n#include "app/render/renderer.h" // no glfw\n',
    "app/sandbox/panels/panel.h": '#pragma once\n#include <imgui.h>\n#include "app/lab/sweep.h"\n',
    "app/main.cpp": '#include <CLI/CLI.hpp>\n#include "app/sandbox/panels/panel.h"\n',
    "tests/lab/sweep_test.cpp": '#include "app/lab/sweep.h"\n#include "tests/lab/oracle.h"\n',
    "tests/lab/oracle.h": "#pragma once\n",
}
VIOLATIONS = [
    ("engine/core/a.h", '#pragma once\n#include "engine/math/types.h"\n', "core comes before math"),
    ("engine/math/a.h", '#pragma once\n#include "engine/geometry/shapes.h"\n', "before geometry"),
    ("engine/geometry/a.cpp", '#include "engine/space/tree.h"\n', "geometry comes before space"),
    ("engine/space/a.cpp", '  #  include "engine/dynamics/world.h"\n', "before dynamics"),
    ("engine/dynamics/methods/a.cpp", '#include "engine/scene/simulation.h"\n', "before scene"),
    ("engine/scene/a.cpp", '\n#include "app/lab/sweep.h"\n', "a.cpp:2: may not include app/lab"),
    ("engine/core/a.cpp", '#include "engine/plumb.h"\n', "for users of the engine"),
    ("engine/extra/a.cpp", '#include "engine/core/check.h"\n', "unknown room engine/extra"),
    ("app/extra/a.cpp", '#include "app/lab/sweep.h"\n', "unknown room app/extra"),
    ("app/render/a.cpp", '#include "app/sandbox/panels/panel.h"\n',
     "app/render may not know app/sandbox"),
    ("app/render/a.cpp", '#include "app/lab/sweep.h"\n', "app/render may not know app/lab"),
    ("app/lab/a.cpp", '#include "app/sandbox/panels/panel.h"\n',
     "app/lab may not know app/sandbox"),
    ("app/lab/a.cpp", "auto c = create_window_context(request);\n", "the lab opens no window"),
    ("app/lab/a.cpp", "#include <GLFW/glfw3.h>\n", "<GLFW/glfw3.h> is not for this file"),
    ("app/render/a.cpp", "#include <GLFW/glfw3.h>\n", "<GLFW/glfw3.h> is not for this file"),
    ("app/render/a.cpp", "#include <GL/osmesa.h>\n", "more than 1: app/render/a.cpp, app"),
    ("app/sandbox/a.cpp", "#include <glad/gl.h>\n", "<glad/gl.h> is not for this file"),
    ("app/render/a.cpp", "#include <imgui.h>\n", "<imgui.h> is not for this file"),
    ("engine/scene/a.cpp", "#include <toml++/toml.h>\n", "toml.h> is not for this file"),
    ("engine/dynamics/a.cpp", "#include <toml++/toml.h>\n", "toml.h> is not for this file"),
    ("engine/core/a.cpp", '#include "tests/lab/oracle.h"\n', "only tests include tests"),
    ("app/lab/a.cpp", '#include "sweep.h"\n', '"sweep.h" is no file of ours'),
    ("engine/math/types.cpp", '#include "engine/core/check.h"\n#include "engine/math/types.h"\n',
     "math/types.h not first"),
    ("engine/math/types.cpp", "", "math/types.h not first"),
    ("engine/core/a.h", "", "a.h: has no #pragma once"),
    ("engine/core/check.h", '#pragma once\n#include "engine/core/check.h"\n', "form a circle"),
]


def self_test():
    faults = [f"the sound tree is called faulty: {message}" for message in check(SOUND)]
    for path, text, expected in VIOLATIONS:
        messages = check({**SOUND, path: text})
        if not any(expected in message for message in messages):
            faults.append(f"not found: {expected!r} in {path} with {text!r}; said {messages}")
    return faults


def main():
    if sys.argv[1:] == ["--self-test"]:
        faults = self_test()
        print(f"{len(VIOLATIONS)} planted violations")
    elif len(sys.argv) == 2:
        tree = read_tree(sys.argv[1])
        faults = check(tree)
        if not any(path.startswith("engine/core/") for path in tree):
            faults.append(f"no sources found under {sys.argv[1]}")
        print(f"{len(tree)} files")
    else:
        sys.exit(__doc__)
    for fault in faults:
        print(fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
