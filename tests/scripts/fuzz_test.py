"""scripts/fuzz: the readers whose coverage it states exist."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Readers(unittest.TestCase):
    def test_each_reader_is_a_file(self):
        script = (ROOT / "scripts" / "fuzz").read_text(encoding="utf-8")
        readers = re.search(r"^readers=\((.*?)^\)", script, re.M | re.S)[1].split()
        self.assertGreater(len(readers), 30)
        self.assertEqual([name for name in readers if not (ROOT / name).is_file()], [])


if __name__ == "__main__":
    unittest.main()
