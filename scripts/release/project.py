"""What all artefacts of a release share: the version, the time, and how a script is run."""

import os
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
VERSION = re.search(r"project\(bendy VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


def git(*words):
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def epoch():
    """The time of everything in a release, in seconds: SOURCE_DATE_EPOCH, or when the commit was made."""
    return int(os.environ.get("SOURCE_DATE_EPOCH") or git("log", "-1", "--format=%ct"))


def run(*command, log=None, **options):
    """Runs a command from the project's root. With `log`, what it says goes there, and its end is shown if it fails."""
    words = [str(word) for word in command]
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(epoch()), "PYTHONDONTWRITEBYTECODE": "1"}
    if log is None:
        return subprocess.run(words, cwd=ROOT, check=True, env=environment, stdout=subprocess.PIPE, text=True, **options).stdout
    with log.open("a", encoding="utf-8") as output:
        done = subprocess.run(words, cwd=ROOT, check=False, env=environment, stdout=output, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        end = "\n".join(log.read_text(encoding="utf-8", errors="replace").splitlines()[-30:])
        raise SystemExit(f"{end}\nscripts/release.sh: this failed: {' '.join(words)}. The whole log is {log}")
    return None
