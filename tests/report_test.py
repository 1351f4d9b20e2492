#!/usr/bin/env python3
"""scenes/report.py, with a program in plumb's place that is interrupted as it charts its third
problem: it ends in one line, keeps what is done, and goes on from there. And its choice among
made-up rows.

usage: report_test.py SOURCE_DIR
"""

import importlib
import pathlib
import random
import subprocess
import sys
import tempfile

# Its parent gets the signal, too, as from a terminal.
PROGRAM = """#!/bin/sh
cd "$(dirname "$0")" && echo "$2" >> calls
[ "$2" = heavy_chain ] && [ ! -e interrupted ] && touch interrupted && kill -INT $PPID && exit 130
exit 0
"""


def row(method, timings, error, work):
    return {"method": method, "cpu_s_per_s": str(sorted(timings)[len(timings) // 2]),
            "cpu_s_per_s_timings": ";".join(map(str, timings)), "body_passes_per_s": str(work),
            "constraint_passes_per_s": "0", "energy.scaled_error": str(error), "error": str(error)}


def check_choice(report):
    """Noise does not decide, a plain difference does."""
    dice = random.Random(1)

    def noisy(cost, noise, rounds):
        return [cost * (1 + dice.uniform(-noise, noise)) for _ in range(rounds)]

    for rounds, noise in ((5, 0.02), (1, 0.04)):
        for _ in range(200):
            rows = [row("tgs_soft", noisy(0.558, noise, rounds), 0.727, 16500),
                    row("soft_step", noisy(0.56, noise, rounds), 0.01, 5940),
                    row("soft_step", noisy(0.563, noise, rounds), 0.0586, 5280)]
            dice.shuffle(rows)
            assert report.cheapest(rows)["body_passes_per_s"] == "5280", rows
            rows.append(row("nncg", noisy(0.4, noise, rounds), 0.9, 99999))
            assert report.cheapest(rows)["method"] == "nncg", rows
    once = [row("soft_step", [1.0], 0.5, 2), row("xpbd", [0.98], 0.2, 3)]
    assert report.cheapest(once, report.own_error)["method"] == "xpbd"
    once[1]["cpu_s_per_s_timings"] = ""  # it diverged, or was interrupted: timed in its run alone
    assert report.cheapest(once)["method"] == "xpbd"


def main():
    sys.dont_write_bytecode = True
    source = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(source / "scenes"))
    check_choice(importlib.import_module("report"))
    with tempfile.TemporaryDirectory() as folder:
        program, out = pathlib.Path(folder) / "plumb", pathlib.Path(folder) / "out"
        program.write_text(PROGRAM, encoding="utf-8")
        program.chmod(0o755)

        def report():
            (program.parent / "calls").unlink(missing_ok=True)
            done = subprocess.run(
                [sys.executable, source / "scenes/report.py", "--program", program, "--out", out,
                 "--quick", "--only", "mass_on_spring,pendulum,heavy_chain,ten_box_stack"],
                capture_output=True, text=True, check=False)
            return done, (program.parent / "calls").read_text(encoding="utf-8").split()

        first, calls = report()
        said = [line for line in first.stderr.splitlines() if not line.startswith("./plumb ")]
        page = (out / "README.md").read_text(encoding="utf-8")
        assert first.returncode == 130, first
        assert len(said) == 1 and said[0].startswith("interrupted: 2 of 4 problems are done"), said
        assert calls == ["mass_on_spring", "pendulum", "heavy_chain"], calls
        assert "## A pendulum" in page and "## A chain with" not in page, page

        second, calls = report()
        page = (out / "README.md").read_text(encoding="utf-8")
        assert second.returncode == 0, second
        assert calls == ["heavy_chain", "ten_box_stack"], calls
        assert "## A pendulum" in page and "## A stack" in page, page
        assert not (out / "done.txt").exists()
        _, calls = report()
        assert len(calls) == 4, calls


if __name__ == "__main__":
    main()
