"""cmake/older_version.py replaces the version of a symbol, and refuses a library that has none or several."""

import pathlib
import struct
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cmake"))
import older_version  # noqa: E402


class OlderVersion(unittest.TestCase):
    # As readelf -V shows it in every program of x86-64.
    def test_the_hash_is_that_of_elf(self):
        self.assertEqual(older_version.elf_hash(b"GLIBC_2.2.5"), 0x09691A75)

    def test_name_and_hash_are_replaced(self):
        library = b"\x7fELF\0GLIBCXX_3.4.30\0rest" + struct.pack("<I", older_version.elf_hash(b"GLIBCXX_3.4.30")) + b"end"
        found = older_version.replaced(library)
        self.assertEqual(found, b"\x7fELF\0GLIBCXX_3.4.11\0rest" + struct.pack("<I", older_version.elf_hash(b"GLIBCXX_3.4.11")) + b"end")

    def test_others_are_refused(self):
        for library in (b"\x7fELF", b"\0GLIBCXX_3.4.30\0GLIBCXX_3.4.30\0"):
            with self.assertRaises(ValueError):
                older_version.replaced(library)


if __name__ == "__main__":
    unittest.main()
