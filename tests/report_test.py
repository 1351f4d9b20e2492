#!/usr/bin/env python3
"""scenes/report.py, with a program in plumb's place that is interrupted as it charts its third
problem: it ends in one line, keeps what is done, and goes on from there.

usage: report_test.py SOURCE_DIR
"""

import pathlib
import subprocess
import sys
import tempfile

# Its parent gets the signal, too, as from a terminal.
PROGRAM = """#!/bin/sh
cd "$(dirname "$0")" && echo "$2" >> calls
[ "$2" = heavy_chain ] && [ ! -e interrupted ] && touch interrupted && kill -INT $PPID && exit 130
exit 0
"""


def main():
    source = pathlib.Path(sys.argv[1])
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
