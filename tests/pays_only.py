#!/usr/bin/env python3
"""A scene pays only for what it uses: counted by callgrind (Debian's valgrind), call by call, over all
steps of a few small worlds.

usage: pays_only.py [PROGRAM]       by default build/release/bin/plumb

What a world lacks must not be called at all within World::step, but for the few instructions with
which a phase sees that it has nothing to do. Free bodies by themselves run no collision detection;
many of them do look for pairs, since any two may meet, unless they all ignore each other; where none
come near each other nothing more. A sensor finds its contacts, and solves none; that nothing is a
sensor costs a flag each contact, which no count of calls shows.

So that nothing is proven of names that are there no more: each pattern must match a function of the
program, and each that a world is to be without must be called by a world that has it.

Exit code 1 when something is paid for that is not used; 77 without valgrind, or where it does not know
this processor's instructions.
"""

import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

STEPS = 20

# What does the work of each part, by patterns of function names.
PARTS = {
    "broad phase": [r"DynamicTree::", r"World::place_colliders"],
    "contact detection": [r"World::collide_candidate"],
    "contact solver": [r"kernels::.*solve_blocks", r"kernels::.*warm_start_blocks"],
    "joints": [r"::solve_group", r"JointSystem::factor", r"JointSystem::solve",
               r"JointSystem::eliminate", r"::emit_point\("],
    "particles and cloth": [r"World::find_particle_contacts", r"World::collide_particle",
                            r"World::load_particles", r"World::end_particles", r"solve_springs",
                            r"solve_particle_contacts"],
}
# What no step of any world calls.
NEVER = [r"::map_scene\(", r"::chart_scene\(", r"::judge_run\(", r"ExpectationWatch::"]

GROUND = """
[[body]]
name = "ground"
kind = "static"
shape = "plane"
"""
BOXES = """
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, HEIGHT, 0]
repeat = { kind = "line", count = COUNT, step = [STEP, 0, 0] }
"""


def boxes(count, height, step=1.4, lines=""):
    return (BOXES.replace("COUNT", str(count)).replace("HEIGHT", str(height))
            .replace("STEP", str(step))) + lines


JOINT = """
[[body]]
name = "hung"
shape = "sphere"
radius = 0.3
position = [-5, 3, 0]

[[joint]]
name = "hook"
type = "ball"
body_b = "hung"
anchor = [-5.5, 3.5, 0]
"""
CLOTH = """
[[cloth]]
name = "sheet"
cells = [4, 4]
size = [1, 1]
position = [0, 1.1, 0]
mass = 0.2
stretch = 100
"""

SENSOR = """
[[body]]
name = "gate"
kind = "static"
shape = "box"
half_extents = [5, 5, 5]
sensor = true
position = [0, 3, 0]
"""

# A world: its text, its method, and the parts that it has.
DETECTION = ["broad phase", "contact detection"]
CONTACTS = [*DETECTION, "contact solver"]
WORLDS = {
    "a body by itself, soft_step": (boxes(1, 3), "soft_step", []),
    "the same, rk4": (boxes(1, 3), "rk4", []),
    "thirty boxes far apart": (boxes(30, 3, step=20), "soft_step", ["broad phase"]),
    "thirty that ignore each other": (boxes(30, 3, lines="ignores = [0]\n"), "soft_step", []),
    "a box within a sensor": (SENSOR + boxes(1, 3), "soft_step", DETECTION),
    "thirty boxes on the ground": (GROUND + boxes(30, 0.5), "soft_step", CONTACTS),
    "boxes with a joint and cloth": (GROUND + boxes(4, 0.5) + JOINT + CLOTH, "soft_step",
                                     [*CONTACTS, "joints", "particles and cloth"]),
}


def functions(program):
    """The names of all functions of the program."""
    done = subprocess.run(["nm", "--demangle", "--defined-only", program], capture_output=True,
                          text=True, check=True)
    return [line.split(" ", 2)[2] for line in done.stdout.splitlines()
            if line.split(" ", 2)[1] in "tTwWuVi"]


def calls(program, scene, method, folder):
    """How often each function was called within World::step."""
    out = pathlib.Path(folder) / "callgrind"
    done = subprocess.run(
        ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--compress-strings=no",
         "--compress-pos=no", "--toggle-collect=plumb::f??::World::step(*", program, "hash",
         str(scene), "--steps", str(STEPS), "--method", method],
        capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program} hash {scene}: exit code {done.returncode}\n{done.stderr}")
    counts, callee = {}, ""
    for line in out.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("cfn="):
            callee = line[4:]
        elif line.startswith("calls="):
            counts[callee] = counts.get(callee, 0) + int(line[6:].split()[0])
    return counts


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    program = sys.argv[1] if len(sys.argv) > 1 else str(root / "build/release/bin/plumb")
    if shutil.which("valgrind") is None:
        print("needs valgrind (Debian's package)")
        return 77
    started = subprocess.run(["valgrind", "--tool=none", program, "--version"], capture_output=True,
                             text=True, check=False)
    if started.returncode == -signal.SIGILL:
        print("valgrind does not know this processor's instructions")
        return 77
    wrong = 0
    there = functions(program)
    of_parts = [pattern for patterns in PARTS.values() for pattern in patterns]
    for pattern in [*of_parts, *NEVER]:
        if not any(re.search(pattern, function) for function in there):
            print(f"{pattern} matches no function of {program}: it proves nothing, WRONG")
            wrong += 1
    called = set()
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, method, has) in WORLDS.items():
            scene = pathlib.Path(folder) / "world.toml"
            scene.write_text(text, encoding="utf-8")
            counts = calls(program, scene, method, folder)
            print(f"{name}: {sum(counts.values()) / STEPS:.0f} calls a step")
            for part, patterns in [*PARTS.items(), ("what no step calls", NEVER)]:
                found = {}
                for pattern in patterns:
                    of_pattern = {f: n for f, n in counts.items() if re.search(pattern, f)}
                    found.update(of_pattern)
                    if of_pattern:
                        called.add(pattern)
                total = sum(found.values())
                fine = total > 0 if part in has else total == 0
                wrong += not fine
                print(f"  {part}: {total} calls{'' if fine else ', WRONG'}")
                if total and part not in has:
                    for function, count in found.items():
                        print(f"    {count}  {function}")
    for pattern in of_parts:
        if pattern not in called:
            print(f"{pattern} is called in no world, not even in one that has it all, WRONG")
            wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
