#!/usr/bin/env python3
"""The table of recipes: for each of the Game Physics Cookbook's, the function, the test and the scene.

    tests/recipes/recipes.py           checks recipes.csv and that scenes/geometry/RECIPES.md is made of it
    tests/recipes/recipes.py --write   writes scenes/geometry/RECIPES.md

Checked is that each function is declared in its header, each test exists, and each scene is there.
"""

import csv
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = pathlib.Path(__file__).with_name("recipes.csv")
PAGE = ROOT / "scenes" / "geometry" / "RECIPES.md"

HEAD = """# The recipes

Chapters 1 to 16 and the appendix of the *Game Physics Cookbook* (G. Szauer, Packt 2017): where each recipe is a
function, which test holds it against what oracle, and in which scene it can be seen (`./plumb run NAME`).

Made by `tests/recipes/recipes.py --write` from `tests/recipes/recipes.csv`; a test fails when a function, a test or
a scene named here is not there.

| chapter | recipe | function | test | scene |
|---|---|---|---|---|
"""


def all_tests():
    """Suite.Case of every test in the sources."""
    pattern = re.compile(r"^\s*(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
    names = set()
    for path in (ROOT / "tests").rglob("*.cpp"):
        names.update(f"{suite}.{case}" for suite, case in pattern.findall(path.read_text()))
    return names


def check(rows):
    """What is wrong with the rows, as lines of text."""
    tests = all_tests()
    scenes = {path.stem for path in (ROOT / "scenes").rglob("*.toml")}
    wrong = []
    for number, row in enumerate(rows, start=2):
        where = f"{TABLE.relative_to(ROOT)}:{number}: {row['recipe']}"
        for part in ("chapter", "recipe", "header", "function", "test", "scene"):
            if not row[part]:
                wrong.append(f"{where}: no {part}")
        if row["header"].startswith("glm/"):
            continue  # GLM's own
        header = ROOT / "engine" / row["header"]
        if not header.is_file():
            header = ROOT / row["header"]
        if not header.is_file():
            wrong.append(f"{where}: there is no header {row['header']}")
        else:
            text = header.read_text()
            for name in row["function"].split(" "):
                if not re.search(rf"\b{re.escape(name)}\b", text):
                    wrong.append(f"{where}: {row['header']} does not declare {name}")
        for name in row["test"].split(" "):
            if name not in tests:
                wrong.append(f"{where}: there is no test {name}")
        for name in row["scene"].split(" "):
            if name not in scenes:
                wrong.append(f"{where}: there is no scene {name}")
    return wrong


def page(rows):
    lines = []
    for row in rows:
        functions = " ".join(f"`{name}`" for name in row["function"].split(" "))
        tests = " ".join(f"`{name}`" for name in row["test"].split(" "))
        scenes = " ".join(f"`{name}`" for name in row["scene"].split(" "))
        lines.append(f"| {row['chapter']} | {row['recipe']} | {functions} (`{row['header']}`) | {tests} | {scenes} |")
    return HEAD + "\n".join(lines) + "\n"


def main():
    with TABLE.open(newline="") as file:
        rows = list(csv.DictReader(file))
    wrong = check(rows)
    if "--write" in sys.argv[1:]:
        PAGE.write_text(page(rows))
    elif not PAGE.is_file() or PAGE.read_text() != page(rows):
        wrong.append(f"{PAGE.relative_to(ROOT)} is not what tests/recipes/recipes.py --write makes")
    print("\n".join(wrong) if wrong else f"{len(rows)} recipes")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
