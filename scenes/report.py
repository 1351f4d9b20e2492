#!/usr/bin/env python3
"""Generates a page of benchmark results: for each problem its charts, stability map, scene file and
commands, and the method, dt, substeps and iterations to use.

usage: scenes/report.py [--program build/release/bin/plumb] [--out out/report] [--only NAME,…]
                        [--quick] [--with bullet,ode] [--publish]

Writes OUT/README.md, with tables and pictures beside it. A full run takes less than half an hour on
two cores; --quick makes only tiny charts, as a smoke test. On Ctrl-C it writes the page as far as it
got, and the same command resumes: OUT/done.txt lists what this program has finished, until all is.
--publish also replaces scenes/report/ with the whole page and its pictures. Exit code 1 if a command
failed.
"""

import argparse
import csv
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # no __pycache__ among the scenes

from report_problems import PROBLEMS, chart_stem, commands_of, in_words

ROOT = pathlib.Path(__file__).resolve().parent.parent
PUBLISHED = ROOT / "scenes/report"

CHOSEN = re.compile(r"is (?P<method>\w+) with (?P<substeps>\S+) substeps?"
                    r"(, (?P<iterations>\d+) iterations?)? and a dt of (?P<dt>\S+ s), in "
                    r"(?P<precision>\w+): (?P<cost>\S+) ms of CPU time per simulated second, worst "
                    r"error (?P<error>\S+) of its tolerance( \((?P<worst>[^)]*)\))?")


def shown_path(path):
    """Relative to the repository if inside it."""
    path = path.resolve()
    return str(path.relative_to(ROOT) if path.is_relative_to(ROOT) else path)


def hertz(seconds):
    return f"1/{1 / seconds:.4g} s"


def substeps_of(row):
    most = int(row["max_substeps"])
    chooses = row["method"] == "soft_step" and most > int(row["substeps"])
    return row["substeps"] + (f" to {most}" if chooses else "")


def share_of_tolerance(row):
    """A run's worst error in units of its tolerance, and the expectation's name."""
    scaled = [(float(value), name.removesuffix(".scaled_error")) for name, value in row.items()
              if name.endswith(".scaled_error") and value]
    return max(scaled, default=(math.inf, ""))


def cost_of(row):
    return float(row["cpu_s_per_s"])


# A run that is not dearer by this factor in every round of timings costs the same, as in `plumb tune`;
# one that was timed only once, by more, since its spread is not known.
SAME_COST, SAME_COST_ONCE = 1.03, 1.1


def costs_the_same(row, other):
    own, its = ([float(time) for time in each["cpu_s_per_s_timings"].split(";") if time] or [cost_of(each)]
                for each in (row, other))
    factor = SAME_COST if min(len(own), len(its)) > 1 else SAME_COST_ONCE
    return any(time <= factor * least for time, least in zip(own, its))


def cheapest(rows, error=lambda row: share_of_tolerance(row)[0]):
    """The cheapest row or, of those that cost the same, each method's with the least counted work,
    and of these the most accurate: noise in the timings does not decide."""
    least = min(rows, key=cost_of)
    best = {}
    for row in rows:
        work = float(row["body_passes_per_s"]) + float(row["constraint_passes_per_s"])
        if costs_the_same(row, least):
            of_method = best.setdefault(row["method"], (work, row))
            if work < of_method[0]:
                best[row["method"]] = (work, row)
    return min((row for _, row in best.values()), key=error)


def own_error(row):
    return float(row["error"])


class Interrupted(Exception):
    pass


class Done:
    """Commands that an interrupted report has finished, kept in a file; only for the same program."""

    def __init__(self, path, program):
        stat = pathlib.Path(program).stat()
        self.path = path
        self.head = f"{program} {stat.st_size} {stat.st_mtime_ns}"
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        self.commands = lines[1:] if lines[:1] == [self.head] else []
        self.any_earlier = bool(self.commands)

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
        self.summary = []  # rows of the table at the top
        self.pictures = []
        self.provenance = ""
        self.done = Done(self.out / "done.txt", self.program)

    def run(self, command, said_to=None):
        """Runs one of the program's commands; its output goes into a file beside the page, if named."""
        shown = in_words(command)
        if shown in self.done.commands:
            return
        print(shown, file=sys.stderr)
        with open(self.out / said_to if said_to else os.devnull, "w", encoding="utf-8") as said:
            with subprocess.Popen([self.program, *command], cwd=ROOT, stdout=said) as process:
                try:
                    code = process.wait()
                except KeyboardInterrupt:  # the program got it too, and saves its rows
                    process.wait()
                    raise Interrupted from None
        if code in (130, 143):
            raise Interrupted
        if code in (0, 3):  # 3: all runs diverged, a valid result
            self.done.add(shown)
        else:
            self.failed.append(f"{shown}: exit code {code}")

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
            self.pictures.append(name)
            self.say(f"![{what}]({name})", "")

    def cheapest_of_each_method(self, rows):
        """Among runs that meet all expectations and, in one-step charts, have an error at most 10 %
        above the smallest. Returns their rows."""
        found = []
        single = "one_step_rms_m" in rows[0]
        fine = [row for row in rows if row["status"] == "fine"]
        least = min((float(row["error"]) for row in fine), default=0)
        if single:
            self.say("The cheapest run of each method that meets all expectations and has a "
                     "single-step error (root mean square) at most 10 % above the smallest, "
                     f"{1e3 * least:.3g} mm:", "",
                     "| method | dt | substeps | iterations | CPU time per simulated second "
                     "| real-time factor | single-step error |", "|---|---|---|---|---|---|---|")
        else:
            self.say("The cheapest run of each method on the chart that is accurate enough:", "",
                     "| method | dt | substeps | iterations | CPU time per simulated second "
                     "| real-time factor | worst error / tolerance |",
                     "|---|---|---|---|---|---|---|")
        for method in dict.fromkeys(row["method"] for row in rows):
            own = [row for row in rows if row["method"] == method]
            enough = [row for row in own if row["status"] == "fine" and
                      (not single or float(row["error"]) <= 1.1 * least)]
            if enough:
                best = cheapest(enough)
                found.append(best)
                error, worst = share_of_tolerance(best)
                error = (f"{1e3 * float(best['error']):.3g} mm" if single else
                         f"{error:.2g}" + (f" ({worst})" if error else ""))
                self.say(f"| {method} | {hertz(float(best['dt_s']))} | {substeps_of(best)} | "
                         f"{best['iterations']} | {1e3 * float(best['cpu_s_per_s']):.3g} ms | "
                         f"{1 / float(best['cpu_s_per_s']):.2g} | {error} |".replace("e+0", "e"))
                continue
            error, worst = min(map(share_of_tolerance, own))
            if single and any(row["status"] == "fine" for row in own):
                error = min(float(row["error"]) for row in own if row["status"] == "fine")
                why = f"at best {1e3 * error:.3g} mm"
            elif all(row["status"] == "diverged" for row in own):
                why = "diverges"
            else:
                times = " times its tolerance" if single else ""
                why = f"at best {error:.3g}{times} ({worst})" if error < math.inf else "no result"
                why = f"misses an expectation, {why}" if single else why
            self.say(f"| {method} | – | – | – | – | – | none: {why} |")
        self.say("")
        return found

    def answer_of_chart(self, problem, enough):
        """For a problem that is not tuned: the cheapest run on the chart."""
        if problem.notes:
            self.say(problem.notes, "")
        if not enough:
            return
        best = cheapest(enough)
        cost, dt = f"{1e3 * float(best['cpu_s_per_s']):.3g} ms", hertz(float(best["dt_s"]))
        error, worst = share_of_tolerance(best)
        error = f"{error:.2g}" + (f" ({worst})" if error else "")
        self.say(f"**Answer, from the chart: {best['method']}, dt {dt}, substeps {substeps_of(best)}, "
                 f"iterations {best['iterations']}**: {cost} of CPU time per simulated second.", "")
        self.summary.append([f"[{problem.kind}](#{anchor(problem.title)})", best["method"], dt,
                             substeps_of(best), best["iterations"], cost, error])

    def map_table(self, problem, rows):
        """Returns the number of cells held by each method, and the number of cells."""
        head = "| method | cells held | failures |"
        if problem.product:
            head = f"| method | cells held | failures | {problem.product_name} at the limits found |"
        self.say(head, "|---" * (head.count("|") - 1) + "|")
        held = {}
        for method in dict.fromkeys(row["method"] for row in rows):
            cells = [row for row in rows if row["method"] == method and row["kind"] == "cell"]
            fails = [row["why"] for row in cells if row["why"] != "held"]
            held[method] = len(cells) - len(fails)
            limits = [problem.product(math.sqrt(float(row["low"]) * float(row["high"])),
                                      float(list(row.values())[3]))  # y
                      for row in rows if problem.product and row["method"] == method and
                      row["kind"] == "limit"]
            ends = list(dict.fromkeys(f"{limit:.3g}" for limit in sorted(limits)))
            found = f" {' to '.join(ends[:1] + ends[1:][-1:]) or '–'} |"
            why_not = ", ".join(f"{fails.count(why)} {why}" for why in dict.fromkeys(fails))
            self.say(f"| {method} | {held[method]} of {len(cells)} | {why_not or '–'} |" +
                     (found if problem.product else ""))
        self.say("")
        if rows[0]["not_judged"]:
            self.say(f"Not judged on this map, as they do not hold all over it: {rows[0]['not_judged']}.",
                     "")
        return held, len(cells)

    def answer_of_map(self, problem, rows, charted):
        held, cells = self.map_table(problem, rows)
        if problem.notes:
            self.say(problem.notes, "")
        most = max(held.values())
        best = [method for method in held if held[method] == most]
        steps = [float(row["dt"]) for row in rows if row["kind"] == "cell"]
        span = f"{hertz(min(steps))} to {hertz(max(steps))}"
        # From the chart, at the scene's own dt: the run with the map's substeps.
        cost = [float(row["cpu_s_per_s"]) for row in charted
                if row["method"] == best[0] and substeps_of(row) == problem.mapped_substeps]
        cost = f"{1e3 * cost[0]:.3g} ms" if cost else "–"
        self.say(f"**Answer: {' or '.join(best)}, any dt from {span}, substeps "
                 f"{problem.mapped_substeps}, iterations 1**: {most} of {cells} cells held, more than "
                 "any other method on the map.", "")
        self.summary.append([f"[{problem.kind}](#{anchor(problem.title)})", " or ".join(best), span,
                             problem.mapped_substeps, "1", cost, f"{most} of {cells} cells held"])

    def answer_of_tuning(self, problem, steps):
        """What was tuned or, given the rows of accurate enough single steps, the cheapest of these."""
        path = self.out / f"{problem.scene}.tune.txt"
        found = CHOSEN.search(path.read_text(encoding="utf-8")) if path.exists() else None
        if problem.notes:
            self.say(problem.notes, "")
        if not found:
            return
        if steps:
            best = cheapest(steps, own_error)
            cost = f"{1e3 * float(best['cpu_s_per_s']):.3g} ms"
            error = f"{1e3 * float(best['error']):.3g} mm"
            dt = hertz(float(best["dt_s"]))
            self.say(f"**Answer: {best['method']}, dt {dt}, substeps {substeps_of(best)}, iterations "
                     f"{best['iterations']}**: {cost} of CPU time per simulated second, single-step "
                     f"error {error}. For the scene's own expectations alone, little penetration at "
                     f"the end and no energy gain, `plumb tune` finds {found['method']}, dt "
                     f"{found['dt']}, substeps {found['substeps'].replace('..', ' to ')}, iterations "
                     f"{found['iterations']}, at {found['cost']} ms.", "")
            self.summary.append([f"[{problem.kind}](#{anchor(problem.title)})", best["method"], dt,
                                 substeps_of(best), best["iterations"], cost, error + " per step"])
            return
        iterations = found["iterations"] or "–"
        worst = f" ({found['worst']})" if found["worst"] else ""
        self.say(f"**Answer: {found['method']}, dt {found['dt']}, substeps "
                 f"{found['substeps'].replace('..', ' to ')}" +
                 (f", iterations {iterations}" if found["iterations"] else "") +
                 f", in {found['precision']}**: {found['cost']} ms of CPU time per simulated second, "
                 f"worst error {found['error']} of its tolerance{worst}. `plumb tune` found nothing "
                 "cheaper.", "")
        self.summary.append([f"[{problem.kind}](#{anchor(problem.title)})", found["method"],
                             found["dt"], found["substeps"].replace("..", " to "), iterations,
                             f"{found['cost']} ms", found["error"] + worst])

    def problem(self, problem):
        self.say(f"## {problem.title}", "", problem.asked, "")
        commands = commands_of(problem, shown_path(self.out), self.quick)
        for command in commands:
            self.run(command, f"{problem.scene}.tune.txt" if command[0] == "tune" else None)
        charted = []
        for command in commands:
            if command[0] != "chart":
                continue
            stem = chart_stem(problem.scene, command)
            kind = ("error against dt" if "--convergence" in command else
                    "single-step error against cost" if "--one-step" in command else
                    "error against cost")
            self.picture(stem + ".png", f"{problem.title}: {kind}")
            if "--convergence" not in command:
                charted = self.rows(stem + ".csv")
        if self.engines and "--one-step" not in commands[0]:
            other = ["chart", problem.scene, *commands[0][2:-2], "--with", self.engines, "--out",
                     shown_path(self.out / "engines")]
            self.run(other)
            commands.append(other)
            self.picture(f"engines/{problem.scene}.png", f"{problem.title}: compared with other engines")
        enough = []
        if charted:
            enough = self.cheapest_of_each_method(charted)
            self.provenance = f"{charted[0]['machine']}; commit {charted[0]['commit']}"
        area = self.rows(f"{problem.scene}.map.csv") if problem.area and not self.quick else []
        if area:
            self.picture(f"{problem.scene}.map.png", f"{problem.title}: stability map")
        if area and problem.tune is None:
            self.answer_of_map(problem, area, charted)
        elif not self.quick:
            if area:
                self.map_table(problem, area)
            if problem.tune is None:
                self.answer_of_chart(problem, enough)
            single = any("--one-step" in command for command in commands)
            if problem.tune is not None:
                self.answer_of_tuning(problem, enough if single else [])
        files = sorted((ROOT / "scenes").rglob(problem.scene + ".toml"))
        path = files[0].relative_to(ROOT / "scenes") if files else problem.scene
        self.say(f"Scene: [`scenes/{path}`](../{path})", "", "    " +
                 "\n    ".join(map(in_words, commands)), "")

    def page(self, seconds, cpu_seconds):
        head = ["# Which dt, which method, how many iterations?", "",
                "Each problem is run with every method that supports it, at the scene's own dt and 1 "
                "to 16 substeps unless its command says otherwise; numbers on the charts are "
                "substeps. A run is accurate enough if it meets all of the scene's expectations, "
                "each within its own tolerance. Errors are in units of that tolerance, and the worst "
                "counts; charts of a single expectation use its own unit. Costs are CPU time per "
                "simulated second on one thread, in float: ratios hold, milliseconds do not.",
                "",
                "The answer is the cheapest setting that `plumb tune` finds among all methods, dt "
                "(twice to a quarter of the scene's), substeps, iterations (1, 2, 4, 8) and "
                "precisions, with a margin of a fifth of each tolerance and from four starts, unless "
                "the command says otherwise. With a map and no tuning, it is the method that holds "
                "the most cells; for published scenes, the cheapest dot that is accurate enough; for "
                "the heap, the cheapest with nearly the smallest single-step error. Dots close in "
                "cost may swap places between runs: of those that cost the same within the noise, each "
                "method's with the least counted work counts, and then the most accurate.",
                ""]
        if self.summary:
            head += ["| kind of scene | method | dt | substeps | iterations | cost | worst error / "
                     "tolerance |", "|---|---|---|---|---|---|---|"]
            head += ["| " + " | ".join(row) + " |" for row in self.summary]
            head += [""]
        made = f"Generated by `scenes/report.py --publish` on {time.strftime('%Y-%m-%d')}"
        if seconds is not None:
            made += f" in {seconds / 60:.0f} min, {cpu_seconds / 60:.0f} min of CPU time"
        if self.provenance:
            made += f"; {self.provenance}"
        head += [made + ". Each section's commands reproduce it in `out/report`.", ""]
        return "\n".join(head + self.lines)

    def publish(self, text):
        shutil.rmtree(PUBLISHED, ignore_errors=True)
        PUBLISHED.mkdir()
        for name in self.pictures:
            shutil.copyfile(self.out / name, PUBLISHED / name)
        (PUBLISHED / "README.md").write_text(text, encoding="utf-8")


def anchor(title):
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/plumb"))
    parser.add_argument("--out", default=str(ROOT / "out/report"))
    parser.add_argument("--only", default="", help="only these scenes (default: all)")
    parser.add_argument("--quick", action="store_true", help="tiny charts only")
    parser.add_argument("--with", dest="engines", default="",
                        help="also chart other engines, as plumb chart --with does")
    parser.add_argument("--publish", action="store_true",
                        help="also replace scenes/report/")
    options = parser.parse_args()
    options.program = str(pathlib.Path(options.program).resolve())
    only = [name for name in options.only.split(",") if name]
    unknown = [name for name in only if name not in [p.scene for p in PROBLEMS]]
    if unknown:
        parser.error(f"unknown scene {unknown[0]}; there are {', '.join(p.scene for p in PROBLEMS)}")
    if options.publish and (only or options.quick or options.engines):
        parser.error("--publish needs the whole page: drop --only, --quick and --with")
    if not pathlib.Path(options.program).is_file():
        parser.error(f"{options.program} does not exist; ./plumb builds it")
    pathlib.Path(options.out).mkdir(parents=True, exist_ok=True)
    report = Report(options)
    begin, problems = time.monotonic(), [p for p in PROBLEMS if not only or p.scene in only]
    page = report.out / "README.md"
    for number, problem in enumerate(problems):
        first = len(report.lines)
        try:
            report.problem(problem)
        except (Interrupted, KeyboardInterrupt):
            del report.lines[first:]
            page.write_text(report.page(None, None), encoding="utf-8")
            print(f"interrupted: {number} of {len(problems)} problems are done and in {page}; the "
                  "same command resumes", file=sys.stderr)
            return 130
    used = os.times()
    text = report.page(None if report.done.any_earlier else time.monotonic() - begin,
                       used.children_user + used.children_system)
    page.write_text(text, encoding="utf-8")
    print(f"wrote {page}", file=sys.stderr)
    for failure in report.failed:
        print(failure, file=sys.stderr)
    if report.failed:
        return 1
    report.done.clear()
    if options.publish:
        report.publish(text)
        print(f"wrote {PUBLISHED}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
