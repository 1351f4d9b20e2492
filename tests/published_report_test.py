#!/usr/bin/env python3
"""The published page of charts and maps (scenes/report/) is of what scenes/report.py makes: its
problems, their scenes and commands; its pictures are there, and it names nobody's machine.

usage: published_report_test.py SOURCE_DIR [PROGRAM]

With the program, each option of each command is one that its help tells.
"""

import importlib
import pathlib
import re
import subprocess
import sys


def main():
    sys.dont_write_bytecode = True
    source = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(source / "scenes"))
    report = importlib.import_module("report")
    folder = source / "scenes/report"
    page = (folder / "README.md").read_text(encoding="utf-8")

    pictures = re.findall(r"!\[[^]]+\]\(([^)]+)\)", page)
    assert sorted(pictures) == sorted(path.name for path in folder.glob("*.png")), pictures
    for link in re.findall(r"\]\(([^)#]+)\)", page):
        assert (folder / link).is_file(), f"{link} is not there"
    titles = re.findall(r"^## (.+)$", page, re.MULTILINE)
    assert titles == [problem.title for problem in report.PROBLEMS], titles
    for kind, anchor in re.findall(r"\| \[([^]]+)\]\(#([^)]+)\)", page):
        assert anchor in map(report.anchor, titles), kind
    assert len(re.findall(r"^\*\*Answer(, from the chart)?: ", page, re.MULTILINE)) == len(titles)

    commands = [command for problem in report.PROBLEMS for command in report.commands_of(problem)]
    shown = re.findall(r"^    (\./plumb .+)$", page, re.MULTILINE)
    assert shown == list(map(report.in_words, commands)), "make it again: scenes/report.py --publish"
    for words in commands:
        scene = list((source / "scenes").rglob(words[1] + ".toml"))
        assert len(scene) == 1, words[1]
        text = scene[0].read_text(encoding="utf-8")
        for option, value in zip(words, words[1:]):
            if option == "--expect":
                assert f'name = "{value}"' in text, value
    if len(sys.argv) > 2 and sys.argv[2]:
        for command in {words[0] for words in commands}:
            told = subprocess.run([sys.argv[2], command, "--help"], capture_output=True, text=True,
                                  check=True).stdout
            for words in commands:
                for word in words:
                    if words[0] == command and word.startswith("--"):
                        assert re.search(rf"{word}\b", told), f"{command} has no {word}"

    assert not re.search(r"(^|[\s`(\"])/\w+/", page), "an absolute path"
    assert "-changed" not in page and re.search(r"commit [0-9a-f]{12}\b", page)
    size = sum(path.stat().st_size for path in folder.iterdir())
    assert size < 5e6, f"{size} bytes"


if __name__ == "__main__":
    main()
