"""The page that shows characters, and the site of the documentation. Both need what the artefact npm builds."""

import shutil
import tempfile
from pathlib import Path

from archives import files_of, write_tar
from project import ROOT, VERSION, epoch, run


PAGE = ROOT / "bindings/web/dist/page.html"


def check_built():
    if not PAGE.exists():
        raise SystemExit("scripts/release.sh: the page and the site need what npm builds")


def make_page(folder, log):
    check_built()
    shutil.copy(PAGE, folder / f"bendy-{VERSION}-page.html")


def make_site(folder, log):
    check_built()
    name = f"bendy-{VERSION}-site"
    with tempfile.TemporaryDirectory() as work:
        run("scripts/make_site.py", work, log=log)
        site = Path(work, "site")
        write_tar(folder / f"{name}.tar.gz", {f"{name}/{path.relative_to(site)}": path for path in files_of(site)}, epoch())
