"""Checks of scripts/docs that do not need MkDocs: pages are in the navigation, links lead to files. README.md
has the figures of the measured pages."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\((?!https?://|#)([^)#\s]+)")


class Pages(unittest.TestCase):
    def test_every_page_is_in_the_navigation(self):
        navigation = set(re.findall(r"- (?:[\w ]+: )?(\S+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.M))
        pages = {str(page.relative_to(ROOT)) for page in (ROOT / "docs").rglob("*.md")}
        self.assertEqual(navigation, pages | {"README.md", "HACKING.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"})

    def test_the_site_loads_nothing_from_elsewhere(self):
        settings = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
        self.assertIn("  - offline", settings)  # search without a server, by the script iframe-worker of ours
        listed = re.findall(r"^ +- (docs/\S+\.(?:js|css))$", settings, re.M)
        self.assertIn("docs/iframe-worker.js", listed)
        self.assertEqual([name for name in listed if not (ROOT / name).is_file()], [])
        self.assertNotRegex(settings, r"https?://")

    def test_links_lead_to_files(self):
        for page in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "scenes").rglob("*.md")]:
            text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
            text = re.sub(r"`[^`\n]*`", "", text)
            for target in LINK.findall(text):
                self.assertTrue((page.parent / target).exists(), f"{page}: {target}")

    def test_output_follows_the_commands_that_print_it(self):
        for page in (ROOT / "docs").rglob("*.md"):
            blocks = re.findall(r"^```(\w*)\n(?:(?!```).*\n)*```$", page.read_text(encoding="utf-8"), re.M)
            for before, language in zip([None, *blocks], blocks):
                if language == "output":
                    self.assertIn(before, ("sh", "python"), page)

    def test_figures_are_those_of_the_measured_pages(self):
        text = lambda page: " ".join((ROOT / page).read_text(encoding="utf-8").split())
        readme, radiometry = text("README.md"), text("docs/radiometry.md")
        # Differences of leaf_lambert and their standard errors, by wavelength.
        lambert = {nm: (float(x), float(se)) for nm, x, se in re.findall(r"\| (\d+) nm \| [^|]*\| ([+-][\d.]+) ± ([\d.]+) %", radiometry)}
        stated = re.findall(r"(\d+) % at (\d+) nm", readme)
        self.assertEqual([nm for _, nm in stated], ["450", "550"])
        for percent, nm in stated:
            self.assertEqual(percent, f"{lambert[nm][0]:.0f}", nm)
        self.assertIn("at 800 nm no difference is measured", readme)
        self.assertLess(abs(lambert["800"][0]), 2 * lambert["800"][1])


if __name__ == "__main__":
    unittest.main()
