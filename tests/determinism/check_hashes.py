#!/usr/bin/env python3
"""Converts files and holds the outputs' SHA-256 against those that are kept: the same bytes from every compiler.

    check_hashes.py --bendy PROGRAM [--corpus FOLDER]           what hashes.txt has: the examples and seeds, or the corpus
    check_hashes.py --bendy PROGRAM [--corpus FOLDER] --print   the hashes that this program gives, for another program's
    check_hashes.py --bendy PROGRAM [--corpus FOLDER] --plain   the same of conversions without options only: these are quick
    check_hashes.py --bendy PROGRAM [--corpus FOLDER] --renew   writes them into hashes.txt; where bytes may change only

A line is: hash, source, options. Sources are examples/NAME, seeds/NAME as make_seeds.py makes them, corpus/NAME. Other
versions of zstd and meshoptimizer may give other bytes with --compact: the kept ones are of Debian 12's.
"""

import argparse
import hashlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
HASHES = HERE / "hashes.txt"
sys.path.insert(0, str(HERE.parent / "seeds"))
import make_seeds  # noqa: E402

WAYS = ([], ["--compact"], ["--lod"])
SLOW_BYTES = 300_000  # what is larger is converted plainly only


def cases_of_ours(folder):
    """Each case's name with the source's path and the options."""
    for name in ("mannequin", "tentacle"):
        for options in (*WAYS, ["--keep-order"], ["--auto-rig"]):
            yield (f"examples/{name}.glb", SOURCE / "examples" / f"{name}.glb", options)
    sources = make_seeds.make_sources(folder)
    for source, options in make_seeds.conversions(sources).values():
        yield f"seeds/{source}", sources[source], options
    for path in sorted((SOURCE / "tests" / "seeds").glob("*.bendy")):
        yield f"seeds/{path.name}", path, []


def cases_of_corpus(corpus):
    for path in sorted(corpus.rglob("*")):
        if path.suffix not in (".gltf", ".glb") or "malformed" in path.parts:
            continue
        for options in WAYS:
            if not options or path.stat().st_size <= SLOW_BYTES:
                yield f"corpus/{path.relative_to(corpus)}", path, options


def hash_of(bendy, path, options, out):
    """The SHA-256 of what the program makes of a file, or "refused"."""
    result = subprocess.run([bendy, "convert", "-q", path, "-o", out, *options], capture_output=True, check=False)
    if result.returncode not in (0, 1):
        sys.exit(f"{path}: {result.stderr.decode(errors='replace')}")
    if result.returncode == 1:
        return "refused"
    digest = hashlib.sha256(out.read_bytes()).hexdigest()
    out.unlink()
    return digest


def run_all(bendy, corpus, jobs, plain):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cases = [case for case in (cases_of_corpus(corpus) if corpus else cases_of_ours(folder)) if not (plain and case[2])]
        with ThreadPoolExecutor(jobs) as workers:
            hashes = workers.map(lambda case: hash_of(bendy, case[1][1], case[1][2], folder / f"{case[0]}.bendy"),
                              enumerate(cases))
            lines = {}
            for (source, path, options), digest in zip(cases, hashes):
                shown = [option if not option.endswith(".json") else "RIG" for option in options]
                lines[" ".join([source, *shown])] = digest
            return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bendy", required=True)
    parser.add_argument("--corpus", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--print", action="store_true", dest="is_printed")
    parser.add_argument("--plain", action="store_true")
    parser.add_argument("--renew", action="store_true")
    arguments = parser.parse_args()
    found = run_all(arguments.bendy, arguments.corpus, arguments.jobs, arguments.plain)
    if arguments.is_printed:
        print("\n".join(f"{digest} {case}" for case, digest in found.items()))
        return 0
    kept = dict(reversed(line.split(" ", 1)) for line in HASHES.read_text(encoding="utf-8").splitlines()) \
        if HASHES.exists() else {}
    is_ours = lambda case: case.startswith("corpus/") == bool(arguments.corpus)  # noqa: E731
    if arguments.renew:
        kept = {case: digest for case, digest in kept.items() if not is_ours(case)} | found
        HASHES.write_text("".join(f"{kept[case]} {case}\n" for case in sorted(kept)), encoding="utf-8")
        return 0
    kept = {case: digest for case, digest in kept.items() if is_ours(case) and not (arguments.plain and " --" in case)}
    wrong = [case for case in sorted(kept.keys() | found.keys()) if kept.get(case) != found.get(case)]
    for case in wrong:
        print(f"{case}: {kept.get(case, 'not in hashes.txt')} is kept, {found.get(case, 'nothing')} was made")
    print(f"{len(found)} outputs, {len(wrong)} of them not as kept")
    return 1 if wrong or not found else 0


if __name__ == "__main__":
    sys.exit(main())
