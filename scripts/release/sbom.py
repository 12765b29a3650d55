"""The bill of materials, as SPDX 2.3: each file of the release, the libraries that are in it, and the packages that it asks for.

What is in a file comes from packaging/notices/notices.json, which scripts/notices.py compares with each build; versions come from
the packages that the build has used."""

import functools
import hashlib
import json
import re
import sys
import time
import zipfile

from project import ROOT, VERSION, epoch, run

sys.path.insert(0, str(ROOT / "scripts"))
import notices  # noqa: E402

NAME = f"bendy-{VERSION}.spdx.json"
OWN_LICENCE = "MIT"


def identifier(text):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.]+", "-", text).strip("-")


def licence_of(library):
    """The identifier of SPDX for the name of a file in packaging/notices."""
    return {"LGPL-2.1": "LGPL-2.1-or-later"}.get(library["licence"], re.sub(r"^(BSD-3-Clause)-.*", r"\1", library["licence"]))


@functools.cache
def installed():
    """{package: version} of this machine."""
    lines = run("dpkg-query", "-W", "-f", "${Package} ${Version}\n").splitlines()
    return dict(line.split(" ") for line in lines)


def debian_version(package):
    """The version that is installed, or, of a library that only cross builds use, that of the sources that they have unpacked."""
    if installed().get(package):
        return installed()[package]
    source = package.removeprefix("lib").removesuffix("-dev")
    for path in sorted(ROOT.glob(f"build/cross/*/sources/{source}-[0-9]*")):
        return path.name.removeprefix(f"{source}-")
    raise SystemExit(f"scripts/release.sh: no version of {package} is known: it is not installed, and no build has its sources")


def npm_version(package):
    lock = json.loads((ROOT / "bindings/web/package-lock.json").read_text(encoding="utf-8"))
    return lock["packages"][f"node_modules/{package}"]["version"]


def package(name, version, licence, supplier, purl=None):
    entry = {"SPDXID": identifier(f"{name}-{version}"), "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION",
             "filesAnalyzed": False, "licenseConcluded": "NOASSERTION", "licenseDeclared": licence, "copyrightText": "NOASSERTION",
             "supplier": supplier}
    if purl is not None:
        entry["externalRefs"] = [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": purl}]
    return entry


def library_package(library):
    if "npm" in library:
        version = npm_version(library["npm"])
        entry = package(library["name"], version, licence_of(library), "NOASSERTION", f"pkg:npm/{library['npm']}@{version}")
    else:
        version = debian_version(library["debian"])
        entry = package(library["name"], version, licence_of(library), "Organization: Debian", f"pkg:deb/debian/{library['debian']}@{version}")
    entry["copyrightText"] = "\n".join(library["copyright"]) or "NOASSERTION"
    return entry


def bundled_packages(wheel):
    """The libraries that are files of a wheel: those that make_wheel.py has copied from Debian's packages."""
    for name in sorted(zipfile.ZipFile(wheel).namelist()):
        match = re.fullmatch(r"bendy\.libs/(.+)-[0-9a-f]{8}\.so[.\d]*", name)
        if match:
            owner = run("dpkg-query", "--search", f"*/{match[1]}.so*").split(":")[0]
            version = debian_version(owner)
            yield package(owner, version, "NOASSERTION", "Organization: Debian", f"pkg:deb/debian/{owner}@{version}")


def asked_for(deb):
    """The packages that a Debian package depends on, with the versions that it asks for."""
    for word in run("dpkg-deb", "-f", deb, "Depends").strip().split(", "):
        match = re.match(r"(\S+)(?: \((.+)\))?", word)
        yield package(match[1], match[2] or "any", "NOASSERTION", "Organization: Debian")


def artefact_package(path):
    entry = package(path.name, VERSION, OWN_LICENCE, "Organization: The Bendy contributors")
    entry |= {"SPDXID": identifier(path.name), "packageFileName": path.name, "copyrightText": "Copyright 2026 The Bendy contributors"}
    entry["checksums"] = [{"algorithm": "SHA256", "checksumValue": hashlib.sha256(path.read_bytes()).hexdigest()}]
    return entry


def contents(path, kind):
    """(relation, package) for each library of a file. kind: the file's name in packaging/notices/notices.json, or None."""
    for library in notices.LIBRARIES:
        if kind in library["in"] and library["licence"]:
            yield "CONTAINS", library_package(library)
    if path.suffix == ".whl":
        yield from (("CONTAINS", entry) for entry in bundled_packages(path))
    if path.suffix == ".deb":
        yield from (("DEPENDS_ON", entry) for entry in asked_for(path))


def make(folder, kinds):
    """kinds: {name of a file: its kind, see contents}"""
    packages, relations = {}, []
    for name, kind in kinds.items():
        artefact = artefact_package(folder / name)
        packages[artefact["SPDXID"]] = artefact
        relations.append(("SPDXRef-DOCUMENT", "DESCRIBES", artefact["SPDXID"]))
        for relation, entry in contents(folder / name, kind):
            packages.setdefault(entry["SPDXID"], entry)
            relations.append((artefact["SPDXID"], relation, entry["SPDXID"]))
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"bendy-{VERSION}",
        "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(epoch())), "creators": ["Tool: scripts/release/sbom.py"]},
        "packages": list(packages.values()),
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in dict.fromkeys(relations)],
    }
    # The name of the document has to be its own: it follows from the files.
    digest = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
    document["documentNamespace"] = f"https://bendy.example/spdx/bendy-{VERSION}-{digest[:16]}"
    (folder / NAME).write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
