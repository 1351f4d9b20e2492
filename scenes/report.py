#!/usr/bin/env python3
"""A page of what the lab finds: a section a problem, with its charts, its map, its scene file and the
commands, and which method, dt, substeps and iterations are enough.

usage: scenes/report.py [--program build/release/bin/plumb] [--out out/report] [--only NAME,…]
                        [--quick] [--with bullet,ode]

Writes OUT/report.md, and the tables and pictures beside it. All of it takes less than half an hour
on two cores; --quick makes tiny charts, to see that it works. Interrupted (Ctrl-C), it writes the page
of what is done, and the same command goes on from there: OUT/done.txt says which commands this
program has finished, until all are. Exit code 1 when a command failed.
"""

import argparse
import csv
import pathlib
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# A problem: its scene, what is asked of it, the options of its chart, and of its map if it has one.
PROBLEMS = [
    ("mass_on_spring", "A spring without friction", "--convergence --expect period", None),
    ("pendulum", "A pendulum's period", "", None),
    ("heavy_chain", "A chain with a heavy end", "", None),
    ("ten_box_stack", "A stack", "--set sleep_after=0", None),
    ("slope_holds", "Friction that holds", "", None),
    ("bounce_half", "Restitution", "", None),
    ("struck_before_wall", "Struck before a wall", "",
     "--x dt=1/480..1/30:9log --y body.heavy.velocity.x=5..80:5log "
     "--methods soft_step,tgs_soft,sequential_impulses"),
    ("hanging_cloth", "Cloth", "", None),
]
QUICK = "--repeats 1 --sweep substeps=1,4 --methods soft_step,sequential_impulses"


class Interrupted(Exception):
    pass


class Done:
    """The commands that an interrupted report has finished, in a file: this program's alone."""

    def __init__(self, path, program):
        stat = pathlib.Path(program).stat()
        self.path = path
        self.head = f"{program} {stat.st_size} {stat.st_mtime_ns}"
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        self.commands = lines[1:] if lines[:1] == [self.head] else []

    def add(self, command):
        self.commands.append(command)
        self.path.write_text("\n".join([self.head, *self.commands]) + "\n", encoding="utf-8")

    def clear(self):
        self.path.unlink(missing_ok=True)


class Report:
    def __init__(self, options):
        self.program, self.out = options.program, pathlib.Path(options.out)
        self.quick, self.engines = options.quick, options.engines
        self.lines, self.failed = [], []
        self.done = Done(self.out / "done.txt", self.program)

    def run(self, *arguments):
        """Runs a command of the program's; returns its text for the page."""
        shown = "plumb " + shlex.join(arguments)
        if shown in self.done.commands:
            return shown
        print(shown, file=sys.stderr)
        with subprocess.Popen([self.program, *arguments], cwd=self.out,
                              stdout=subprocess.DEVNULL) as process:
            try:
                code = process.wait()
            except KeyboardInterrupt:  # which it got, too, and keeps what it has
                process.wait()
                raise Interrupted from None
        if code in (130, 143):
            raise Interrupted
        if code in (0, 3):  # 3: all runs diverged, which is a result
            self.done.add(shown)
        else:
            self.failed.append(f"{shown}: exit code {code}")
        return shown

    def rows(self, table):
        path = self.out / table
        if not path.exists():
            return []
        with path.open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def say(self, *lines):
        self.lines.extend(lines)

    def picture(self, name, what):
        if (self.out / name).exists():
            self.say(f"![{what}]({name})", "")

    def enough(self, rows):
        """A row each method: the cheapest of its runs that meets all that is expected."""
        self.say("| method | dt | substeps | iterations | CPU time a simulated second | worst error |",
                 "|---|---|---|---|---|---|")
        found = []
        for method in dict.fromkeys(row["method"] for row in rows):
            fine = [r for r in rows if r["method"] == method and r["status"] == "fine"]
            if not fine:
                reasons = {r["diverged"] or "misses " + r["worst"] for r in rows
                           if r["method"] == method}
                self.say(f"| {method} | – | – | – | – | none is true enough: "
                         f"{sorted(reasons)[0]} |")
                continue
            best = min(fine, key=lambda r: float(r["cpu_s_per_s"]))
            most = int(best["max_substeps"])
            substeps = best["substeps"] + (f" to {most}" if most > int(best["substeps"]) and
                                           method == "soft_step" else "")
            found.append((float(best["cpu_s_per_s"]), best, substeps))
            self.say(f"| {method} | {1 / float(best['dt_s']):.4g} Hz | {substeps} | "
                     f"{best['iterations']} | {1e3 * float(best['cpu_s_per_s']):.3g} ms | "
                     f"{float(best['error']):.2g} {best['error_unit'].replace('1', '')} |")
        self.say("")
        if found:
            _, best, substeps = min(found, key=lambda entry: entry[0])
            self.say(f"**Enough: {best['method']}, {1 / float(best['dt_s']):.4g} Hz, substeps "
                     f"{substeps}, iterations {best['iterations']}.** It is the cheapest on this "
                     "chart that meets all that the scene expects.", "")

    def problem(self, scene, title, chart, area):
        self.say(f"## {title}", "")
        options = shlex.split(QUICK if self.quick else chart)
        if self.quick and "--convergence" in chart:
            options = ["--convergence", "--sweep", "dt=1/240..1/60"]
        convergence = "--convergence" in options
        commands = [self.run("chart", scene, *options, "--out", ".")]
        stem = scene + (".convergence" if convergence else "")
        self.picture(stem + ".png", f"{title}: the chart")
        if convergence and not self.quick:
            commands.append(self.run("chart", scene, "--out", "."))
            self.picture(scene + ".png", f"{title}: what truth costs")
        elif self.engines:
            commands.append(self.run("chart", scene, *options, "--with", self.engines, "--out",
                                     "engines"))
            self.picture(f"engines/{scene}.png", f"{title}: beside other engines")
        rows = self.rows(scene + ".csv") or self.rows(stem + ".csv")
        if rows:
            self.enough(rows)
        if area and not self.quick:
            commands.append(self.run("map", scene, *shlex.split(area), "--image",
                                     f"{scene}.map.png", "--csv", f"{scene}.map.csv"))
            self.picture(f"{scene}.map.png", f"{title}: where methods break")
        files = sorted((ROOT / "scenes").rglob(scene + ".toml"))
        self.say(f"Scene: `{files[0].relative_to(ROOT)}`" if files else f"Scene: `{scene}`", "")
        self.say("    " + "\n    ".join(commands), "")
        if rows:
            self.say(f"<sub>{rows[0]['machine']}; commit {rows[0]['commit']}</sub>", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/plumb"))
    parser.add_argument("--out", default="out/report")
    parser.add_argument("--only", default="", help="scenes, by name (all)")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--with", dest="engines", default="", help="other engines, as of plumb chart")
    options = parser.parse_args()
    options.program = str(pathlib.Path(options.program).resolve())
    only = [name for name in options.only.split(",") if name]
    unknown = [name for name in only if name not in [p[0] for p in PROBLEMS]]
    if unknown:
        parser.error(f"no problem {unknown[0]}; there are {', '.join(p[0] for p in PROBLEMS)}")
    if not pathlib.Path(options.program).is_file():
        parser.error(f"there is no program {options.program}; ./plumb builds it")
    pathlib.Path(options.out).mkdir(parents=True, exist_ok=True)
    report = Report(options)
    report.say("# Which dt, which method, how many iterations?", "",
               "Made by `scenes/report.py`. Each problem runs by each method that can run it. True "
               "enough is what meets all that the scene expects of itself; of that, the cheapest is "
               "enough.", "")
    problems = [problem for problem in PROBLEMS if not only or problem[0] in only]
    page = report.out / "report.md"
    for number, problem in enumerate(problems):
        begin = len(report.lines)
        try:
            report.problem(*problem)
        except (Interrupted, KeyboardInterrupt):
            del report.lines[begin:]
            page.write_text("\n".join(report.lines), encoding="utf-8")
            print(f"interrupted: {number} of {len(problems)} problems are done and in {page}; the "
                  "same command goes on", file=sys.stderr)
            return 130
    page.write_text("\n".join(report.lines), encoding="utf-8")
    report.done.clear()
    print(f"wrote {page}", file=sys.stderr)
    for failure in report.failed:
        print(failure, file=sys.stderr)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
