#!/usr/bin/env python3
"""Makes hlsl/ and metal/ from skinning.glsl, by glslangValidator and spirv-cross (Debian: glslang-tools, spirv-cross).

    make.py [--check]

--check changes nothing: it fails if a file differs from what would be made. In both cases glslangValidator compiles the HLSL.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PASSES = {"morph": "comp", "motions": "comp", "skin": "comp", "draw": "vert"}
# The options of spirv-cross for each language, and whether its result has been compiled or run.
LANGUAGES = {"hlsl": (["--hlsl", "--shader-model", "50"], "glslangValidator compiles it; it has not been run."),
             "metal": (["--msl", "--msl-version", "20100", "--msl-decoration-binding"], "It has been neither compiled nor run.")}


def run(*command):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def make(name, stage, language, folder):
    """The text of a pass in a language."""
    source, binary = folder / f"{name}.{stage}", folder / f"{name}.spv"
    source.write_text(f"#version 430\n#define BENDY_{name.upper()}\n" + (HERE / "skinning.glsl").read_text())
    run("glslangValidator", "-V", "-o", binary, source)
    options, known = LANGUAGES[language]
    return f"// Made by make.py from BENDY_{name.upper()} of skinning.glsl. {known}\n" + run("spirv-cross", binary, *options)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    is_check = parser.parse_args().check
    different = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for language in LANGUAGES:
            for one, stage in PASSES.items():
                file = HERE / language / f"{one}.{language}"
                text = make(one, stage, language, folder)
                if language == "hlsl":
                    made = folder / file.name
                    made.write_text(text)
                    run("glslangValidator", "-D", "-V", "-e", "main", "-S", stage, "-o", folder / "compiled.spv", made)
                if is_check:
                    different += [] if file.is_file() and file.read_text() == text else [file.relative_to(HERE)]
                    continue
                file.parent.mkdir(exist_ok=True)
                file.write_text(text)
    if different:
        sys.exit("differ from what make.py makes: " + " ".join(map(str, different)))


if __name__ == "__main__":
    main()
