"""The program as one file, for three systems, each with its licences in an archive; and the sources."""

import gzip

from archives import write_tar, write_zip
from project import ROOT, VERSION, epoch, git, run


def archive_program(folder, log, system, preset, write, suffix):
    run("scripts/static.sh", *([preset.removeprefix("static-")] if preset != "static" else []), log=log)
    name = f"bendy-{VERSION}-{system}"
    built = ROOT / "build" / preset
    program = next(path for path in (built / "bendy", built / "bendy.exe") if path.exists())
    write(folder / f"{name}{suffix}", {f"{name}/{path.name}": path for path in (program, built / "LICENSE", built / "NOTICES.txt")}, epoch())


def make_linux(folder, log):
    archive_program(folder, log, "linux-x86_64", "static", write_tar, ".tar.gz")


def make_arm(folder, log):
    archive_program(folder, log, "linux-aarch64", "static-aarch64", write_tar, ".tar.gz")


def make_windows(folder, log):
    archive_program(folder, log, "windows-x86_64", "static-windows", write_zip, ".zip")


def make_sources(folder, log):
    name = f"bendy-{VERSION}"
    tar = log.with_suffix(".tar")
    git("archive", "--format=tar", f"--prefix={name}/", "--output", str(tar), "HEAD")
    (folder / f"{name}.tar.gz").write_bytes(gzip.compress(tar.read_bytes(), 9, mtime=0))
    tar.unlink()
