"""Versions and dates that a release changes by hand are equal everywhere; files that a release recorded do not change. With FROND_TAG, a
tag of Git, also what a release with this tag lacks: scripts/package --check."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


def found(name, pattern):
    return re.search(pattern, text(name), re.M)[1]


def git(root, *arguments):
    return subprocess.run(["git", "-c", f"safe.directory={root}", "-C", root, *arguments], capture_output=True, text=True, check=True).stdout


def changed_records(root):
    """Files below tests/data that differ from those of the tag of their version, which must remain as they are."""
    changed = []
    tags = set(git(root, "tag").split())
    for folder in sorted((root / "tests" / "data").iterdir()):
        tag, below = f"v{folder.name}", f"tests/data/{folder.name}"
        if tag in tags:
            changed += git(root, "diff", "--name-only", tag, "--", below).split()
            changed += git(root, "ls-files", "--others", "--exclude-standard", "--", below).split()
    return changed


class Version(unittest.TestCase):
    version = found("CMakeLists.txt", r"project\(frond VERSION (\S+)")

    def test_the_citation_has_the_version_of_the_project(self):
        self.assertEqual(found("CITATION.cff", r"^version: (.*)$"), self.version)

    def test_the_recipe_of_conda_has_it(self):
        self.assertEqual(found("packaging/conda/recipe.yaml", r'^  version: "(.*)"$'), self.version)

    def test_the_changelog_and_the_citation_have_its_date(self):
        version, date = re.search(r"^## (\S+), (\S+)$", text("CHANGELOG.md"), re.M).groups()
        self.assertEqual(version, self.version)
        if date != "unreleased":
            self.assertEqual(date, found("CITATION.cff", r"^date-released: \"(.*)\"$"))

    def test_names_of_files_in_pages_have_it(self):
        for page in ("README.md", "docs/install.md", "docs/python.md", "Dockerfile"):
            for version in re.findall(r"(?:frond_render-|frond_|libfrond-dev_|frond-)(\d+\.\d+\.\d+)", text(page)):
                self.assertEqual(version, self.version, page)


class Records(unittest.TestCase):
    def test_files_of_released_versions_do_not_change(self):
        try:
            changed = changed_records(ROOT)
        except (OSError, subprocess.CalledProcessError):
            self.skipTest("not a clone of Git")
        self.assertEqual(changed, [], "files that a release recorded have changed: write those of the present version")

    def test_a_change_is_found_once_there_is_a_tag(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for version in ("0.1.0", "0.2.0"):
                (root / "tests" / "data" / version).mkdir(parents=True)
                (root / "tests" / "data" / version / "scene.pbrt").write_text("WorldBegin\n", encoding="utf-8")
            git(root, "init", "-q")
            git(root, "add", ".")
            git(root, "-c", "user.name=t", "-c", "user.email=t@t.invalid", "commit", "-qm", "files")
            for version in ("0.1.0", "0.2.0"):
                (root / "tests" / "data" / version / "scene.pbrt").write_text("WorldBegin # changed\n", encoding="utf-8")
            self.assertEqual(changed_records(root), [])
            git(root, "tag", "v0.1.0")
            (root / "tests" / "data" / "0.1.0" / "more.npy").write_text("", encoding="utf-8")
            self.assertEqual(changed_records(root), ["tests/data/0.1.0/scene.pbrt", "tests/data/0.1.0/more.npy"])


@unittest.skipUnless("FROND_TAG" in os.environ, "no release")
class Tag(unittest.TestCase):
    def test_the_tag_is_that_of_the_version(self):
        self.assertEqual(os.environ["FROND_TAG"], f"v{Version.version}")

    def test_the_version_has_a_date(self):
        self.assertRegex(found("CHANGELOG.md", r"^## \S+, (\S+)$"), r"^\d{4}-\d{2}-\d{2}$")

    def test_the_version_has_recorded_files(self):
        self.assertTrue((ROOT / "tests" / "data" / Version.version).is_dir())

    def test_the_project_has_addresses(self):
        missing = [f"{name}: {what}" for name, pattern, what in (
            ("cmake/FrondPackage.cmake", r"^set\(CPACK_PACKAGE_CONTACT (?!.*frond\.invalid)", "the maintainer's e-mail address is frond.invalid"),
            ("cmake/FrondPackage.cmake", r"^set\(CPACK_PACKAGE_HOMEPAGE_URL", "CPACK_PACKAGE_HOMEPAGE_URL is missing"),
            ("pyproject.toml", r"^\[project\.urls\]$", "[project.urls] is missing"),
            ("CITATION.cff", r"^repository-code:", "repository-code is missing")) if not re.search(pattern, text(name), re.M)]
        self.assertEqual(missing, [], "the owner of the project adds these (HACKING.md, A release)")


if __name__ == "__main__":
    unittest.main()
