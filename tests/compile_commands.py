#!/usr/bin/env python3
"""The compile commands of a build, one for each source file, also where several are one unit.

usage: compile_commands.py BUILD_DIR >compile_commands.json
"""

import json
import os
import re
import sys

PART = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def per_file(build):
    """The entries of BUILD_DIR's database; a unity source's once for each file that it includes."""
    with open(os.path.join(build, "compile_commands.json")) as stream:
        entries = json.load(stream)
    found = []
    for entry in entries:
        file = entry["file"]
        if os.path.basename(os.path.dirname(file)) != "Unity":
            found.append(entry)
            continue
        with open(file) as stream:
            parts = PART.findall(stream.read())
        found += [{**entry, "file": part, "command": entry["command"].replace(file, part)}
                  for part in parts]
    return found


if __name__ == "__main__":
    json.dump(per_file(sys.argv[1]), sys.stdout, indent=1)
