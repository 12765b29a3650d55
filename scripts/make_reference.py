#!/usr/bin/env python3
"""Makes the man pages, the completions for bash, zsh and fish, and docs/cli.md from the output of `bendy --help`.

    scripts/make_reference.py --bendy build/release/cli/bendy --markdown docs/cli.md
    scripts/make_reference.py --bendy PROGRAM --man FOLDER --completions FOLDER
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

from reference.read_help import UnknownHelp, read_program
from reference.write_bash import write_bash
from reference.write_fish import write_fish
from reference.write_man import write_man
from reference.write_markdown import write_markdown
from reference.write_zsh import write_zsh

EXIT_STATUS = [
    (0, "Success"),
    (1, "Failure; or `bendy validate` or `bendy diff` found something"),
    (2, "The command line is wrong; of bendy diff also: a file is bad"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bendy", required=True, help="the program")
    parser.add_argument("--man", type=Path, metavar="FOLDER", help="where the man pages go")
    parser.add_argument("--completions", type=Path, metavar="FOLDER", help="where the completions go")
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="where the page goes")
    arguments = parser.parse_args()

    try:
        program = read_program(arguments.bendy)
    except (OSError, subprocess.CalledProcessError, UnknownHelp) as problem:
        sys.exit(f"make_reference.py: {problem}")
    files = {}
    if arguments.markdown:
        files[arguments.markdown] = write_markdown(program, EXIT_STATUS)
    if arguments.man:
        version = subprocess.run([arguments.bendy, "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
        moment = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())))
        for name, text in write_man(program, version, time.strftime("%Y-%m-%d", moment), EXIT_STATUS).items():
            files[arguments.man / name] = text
    if arguments.completions:
        files[arguments.completions / "bendy"] = write_bash(program)
        files[arguments.completions / "_bendy"] = write_zsh(program)
        files[arguments.completions / "bendy.fish"] = write_fish(program)
    for path, text in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
