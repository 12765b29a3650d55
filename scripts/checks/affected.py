"""Which steps the files changed since a revision can break: what CMake says of targets and tests, and which folder may include which."""

import fnmatch
import importlib.util
import json
import re
import subprocess
from pathlib import Path, PurePosixPath


def changed_files(root, since):
    """Files that differ from a revision, including untracked ones."""
    def names(*arguments):
        done = subprocess.run(["git", *arguments, "-z"], cwd=root, check=True, capture_output=True, text=True)
        return [name for name in done.stdout.split("\0") if name]
    return sorted({*names("diff", "--name-only", since), *names("ls-files", "--others", "--exclude-standard")})


def may_use(root):
    """Each folder, and all that it may include, directly or indirectly: the table of tests/architecture."""
    spec = importlib.util.spec_from_file_location("check_includes", root / "tests/architecture/check_includes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    closed = {}
    for folder in module.MAY_USE:
        found, queue = {folder}, [folder]
        for one in queue:
            more = module.MAY_USE.get(one, set()) - found
            found |= more
            queue += sorted(more)
        closed[folder] = found
    return closed


class Inputs:
    """The source files of a target: whole folders, single folders without subfolders, files, patterns."""

    def __init__(self):
        self.trees, self.folders, self.files = set(), set(), set()

    def add(self, other):
        self.trees |= other.trees
        self.folders |= other.folders
        self.files |= other.files

    def has(self, path):
        parents = {str(parent) for parent in PurePosixPath(path).parents}
        return bool(parents & self.trees) or str(PurePosixPath(path).parent) in self.folders or \
            any(fnmatch.fnmatchcase(path, pattern) for pattern in self.files)


class Build:
    """The targets and tests of a build folder."""

    def __init__(self, root, folder):
        self.root, self.folder, self.allowed = root, folder, may_use(root)
        query = folder / ".cmake/api/v1/query/codemodel-v2"
        query.parent.mkdir(parents=True, exist_ok=True)
        query.touch()
        subprocess.run(["cmake", str(folder)], check=True, stdout=subprocess.DEVNULL)
        reply = folder / ".cmake/api/v1/reply"
        codemodel = json.loads(max(reply.glob("codemodel-v2-*.json")).read_text(encoding="utf-8"))
        self.targets = {}
        for entry in codemodel["configurations"][0]["targets"]:
            self.targets[entry["id"]] = json.loads((reply / entry["jsonFile"]).read_text(encoding="utf-8"))
        self.by_name = {target["name"]: target for target in self.targets.values()}
        self.by_artifact = {str(folder / artifact["path"]): target for target in self.targets.values()
                            for artifact in target.get("artifacts", [])}
        listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=folder, check=True, capture_output=True, text=True)
        self.tests = json.loads(listed.stdout)["tests"]

    def inputs_of_target(self, target):
        inputs, seen, queue = Inputs(), set(), [target]
        for one in queue:
            if one["id"] in seen:
                continue
            seen.add(one["id"])
            queue += [self.targets[dependency["id"]] for dependency in one.get("dependencies", []) if dependency["id"] in self.targets]
            home = one["paths"]["source"]
            if home in self.allowed:
                inputs.trees |= self.allowed[home]
            elif "/" not in home and home not in (".", "tests"):
                inputs.trees.add(home)
            for source in one.get("sources", []):
                path = self.in_project(source["path"])
                if path is not None:
                    inputs.folders.add(str(PurePosixPath(path).parent))
        return inputs

    def in_project(self, word):
        """The path of a file or folder of the project, from its root; None for anything else."""
        path = Path(word) if Path(word).is_absolute() else self.root / word
        try:
            relative = path.resolve().relative_to(self.root)
        except ValueError:
            return None
        if str(relative) == "." or relative.parts[0] == "build" or not path.exists():
            return None
        return relative.as_posix()

    def inputs_of_test(self, test):
        inputs = Inputs()
        for word in test.get("command", []):
            for part in re.split(r"[=\s]", word):
                if part in self.by_artifact:
                    inputs.add(self.inputs_of_target(self.by_artifact[part]))
                elif part and (path := self.in_project(part)) is not None:
                    self.add_path(inputs, path)
        return inputs

    def add_path(self, inputs, path):
        folder = str(PurePosixPath(path).parent)
        if (self.root / path).is_dir():
            inputs.trees.add(path)
        elif path.endswith(".py") and folder != "scripts":
            inputs.trees.add(folder)
        else:
            inputs.files.add(path)

    def inputs_of_step(self, step):
        inputs = Inputs()
        for word in step.uses:
            if word in self.by_name:
                inputs.add(self.inputs_of_target(self.by_name[word]))
            elif (self.root / word).exists():
                self.add_path(inputs, word)
            else:
                inputs.files.add(word)
        for tests in step.tests:
            for test in self.tests:
                labels = next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), [])
                if set(labels) & set(tests.labels):
                    inputs.add(self.inputs_of_test(test))
        return inputs


def steps_since(root, since, steps):
    """The steps to run, and a sentence with the reason."""
    changed = changed_files(root, since)
    if not changed:
        return [], f"Nothing has changed since {since}."
    folder = root / "build/release"
    if not (folder / "CMakeCache.txt").exists():
        return steps, "All steps run: build/release, which knows the dependencies, does not exist. The gate makes it."
    build = Build(root, folder)
    inputs = {step.name: build.inputs_of_step(step) for step in steps}
    unknown = [path for path in changed if not any(found.has(path) for found in inputs.values())]
    if unknown:
        return steps, f"{unknown[0]} has changed, and no step says that it uses it: all steps run."
    chosen = [step for step in steps if any(inputs[step.name].has(path) for path in changed)]
    return chosen, f"{len(changed)} files have changed since {since}: {len(chosen)} of {len(steps)} steps run."
