"""Archives whose bytes depend on names and contents only: sorted, one owner, one time, two modes."""

import gzip
import io
import tarfile
import time
import zipfile


def files_of(folder):
    """The files below a folder, sorted by name."""
    return sorted(path for path in folder.rglob("*") if path.is_file())


def mode_of(path):
    return 0o755 if path.stat().st_mode & 0o100 else 0o644


def write_tar(output, members, seconds):
    """A .tar.gz. members: {name in the archive: Path}; seconds: the time of all, since 1970."""
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name, path in sorted(members.items()):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode, entry.mtime = path.stat().st_size, mode_of(path), seconds
            with path.open("rb") as file:
                archive.addfile(entry, file)
    output.write_bytes(gzip.compress(data.getvalue(), 9, mtime=0))


def write_zip(output, members, seconds):
    """A .zip of the same."""
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, path in sorted(members.items()):
            entry = zipfile.ZipInfo(name, time.gmtime(seconds)[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system, entry.external_attr = 3, (0o100000 | mode_of(path)) << 16
            archive.writestr(entry, path.read_bytes())
