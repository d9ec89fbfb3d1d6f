"""What scripts/docs checks, as far as it goes without MkDocs: pages are in the navigation, links lead to files."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\((?!https?://|#)([^)#\s]+)")


class Pages(unittest.TestCase):
    def test_every_page_is_in_the_navigation(self):
        navigation = set(re.findall(r"- (?:[\w ]+: )?(\S+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.M))
        pages = {f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")}
        self.assertEqual(navigation, pages | {"README.md", "HACKING.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"})

    def test_links_lead_to_files(self):
        for page in [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "scenes").rglob("*.md")]:
            text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
            text = re.sub(r"`[^`\n]*`", "", text)
            for target in LINK.findall(text):
                self.assertTrue((page.parent / target).exists(), f"{page}: {target}")


if __name__ == "__main__":
    unittest.main()
