#!/usr/bin/env python3
"""A folder of characters in; bendy files, a report and a contact sheet out.

    ./pipeline.py SOURCES OUT [--compact] [--lod] [--overwrite] [--size 320x240]

OUT/report.csv has a row for each source; OUT/sheet.png a picture of each character in the middle of its first clip. Exit status 1: some
source failed, and its row says why; 2: nothing is written, because something would be lost. Needs the Python package bendy: docs/python.md.
"""

import argparse
import csv
import os
import sys
from pathlib import Path

import bendy

SUFFIXES = {".glb", ".gltf", ".vrm", ".vrma", ".x", ".md2", ".bvh", ".bendy"}
COLUMNS = ["file", "bytes", "joints", "constraints", "chains", "vertices", "triangles", "clips", "seconds", "faults", "warnings", "error"]


def list_sources(folder):
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES and path.is_file())


def find_losses(targets, written, may_overwrite):
    """Sentences on what would be lost. targets: source -> its bendy file; written: other file -> what it is."""
    def file_of(path):
        """What two names of one file have in common: links lead there."""
        return (path.stat().st_dev, path.stat().st_ino) if path.exists() else path.resolve()

    outputs, inputs = {}, {file_of(path): path for path in targets}
    for target, what in (*((target, source) for source, target in targets.items()), *written.items()):
        if os.path.lexists(target) and not may_overwrite:
            yield f"{target} exists: give another folder, or --overwrite"
        if file_of(target) in inputs:
            yield f"{target} would replace the source {inputs[file_of(target)]}: give another folder"
        # Some systems ignore the case of names.
        others = [outputs.setdefault(key, what) for key in (target.name.casefold(), file_of(target))]
        yield from {f"both {other} and {what} would be written to {target}: rename one" for other in others if other is not what}


def convert(source, target, options):
    """A row of the report, and the model; None if it failed. pandas.DataFrame(rows) takes a list of rows as it is."""
    row = {"file": source.name}
    try:
        made = bendy.convert(source, target, compact=options.compact, lod=options.lod, overwrite=options.overwrite)
        model = bendy.open(made)
    except (bendy.Error, OSError, ValueError) as error:
        return {**row, "error": str(error)}, None
    row.update({name: made.report[name] for name in ("bytes", "joints", "constraints", "chains", "vertices", "triangles")})
    row.update(clips=len(model.clips), seconds=round(sum(clip.seconds for clip in model.clips), 3), faults=len(made.validate()),
               warnings="; ".join(warning["message"] for warning in made.warnings))
    return row, model


def draw(model, size):
    if not model.clips:
        return bendy.render(model, size=size)
    clip = model.clips[0]
    return bendy.render(model, clip, (clip.start + clip.end) / 2, size=size)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sources", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--compact", action="store_true")
    parser.add_argument("--lod", action="store_true")
    parser.add_argument("--overwrite", action="store_true")
    parser.add_argument("--size", default="320x240", type=lambda text: tuple(int(side) for side in text.split("x")))
    options = parser.parse_args()
    report, sheet = options.out / "report.csv", options.out / "sheet.png"
    try:
        targets = {source: options.out / f"{source.stem}.bendy" for source in list_sources(options.sources)}
        if losses := list(find_losses(targets, {report: "the report", sheet: "the sheet"}, options.overwrite)):
            parser.error("\n".join(losses))
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        parser.error(str(error))

    rows, pictures = [], []
    for source, target in targets.items():
        row, model = convert(source, target, options)
        rows.append(row)
        print(f"{source.name}: {row.get('error') or str(row['bytes']) + ' bytes'}")
        if model is not None:
            try:
                pictures.append(draw(model, options.size))
            except (bendy.RenderError, NotImplementedError) as error:
                print(f"{source.name}: no picture: {error}", file=sys.stderr)

    with report.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    if pictures:
        bendy.save_png(bendy.contact_sheet(pictures), sheet, overwrite=options.overwrite)
    return 1 if any("error" in row for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
