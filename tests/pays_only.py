#!/usr/bin/env python3
"""A scene pays only for what it uses: counted by callgrind (Debian's valgrind), call by call, over all
steps of a few small worlds.

usage: pays_only.py [PROGRAM]       by default build/release/bin/plumb

What a world lacks must not be called at all within World::step, but for the few instructions with
which a phase sees that it has nothing to do. A world that has everything must call all of it: a
function that was renamed is so found out. Exit code 1 when something is paid for that is not used.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

STEPS = 20

# What does the work of each part, by patterns of function names.
PARTS = {
    "broad phase": r"DynamicTree::|World::place_colliders",
    "contacts": r"World::collide_candidate|kernels::.*solve_blocks|solve_contact_columns.*blocks"
                r"|World::remember",
    "joints": r"::solve_group|JointSystem::(factor|solve|eliminate)|World::note_joint_loads"
              r"|::joint_rows\(",
    "particles and cloth": r"World::(find_particle_contacts|collide_particle|load_particles"
                           r"|end_particles)|solve_springs|solve_particle_contacts",
    "maps, charts and runs of the lab": r"map_scene|chart_scene|judge_run|ExpectationWatch",
}

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


def boxes(count, height, step=1.4):
    return (BOXES.replace("COUNT", str(count)).replace("HEIGHT", str(height))
            .replace("STEP", str(step)))


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

# A world: its text, its method, and the parts that it has.
WORLDS = {
    "a body by itself, soft_step": (boxes(1, 3), "soft_step", []),
    "the same, rk4": (boxes(1, 3), "rk4", []),
    "thirty boxes on the ground": (GROUND + boxes(30, 0.5), "soft_step",
                                   ["broad phase", "contacts"]),
    "boxes with a joint and cloth": (GROUND + boxes(4, 0.5) + JOINT + CLOTH, "soft_step",
                                     ["broad phase", "contacts", "joints", "particles and cloth"]),
}


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
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, method, has) in WORLDS.items():
            scene = pathlib.Path(folder) / "world.toml"
            scene.write_text(text, encoding="utf-8")
            counts = calls(program, scene, method, folder)
            print(f"{name}: {sum(counts.values()) / STEPS:.0f} calls a step")
            for part, pattern in PARTS.items():
                found = {f: n for f, n in counts.items() if re.search(pattern, f)}
                total = sum(found.values())
                fine = total > 0 if part in has else total == 0
                wrong += not fine
                print(f"  {part}: {total} calls{'' if fine else ', WRONG'}")
                if total and part not in has:
                    for function, count in found.items():
                        print(f"    {count}  {function}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
