"""Folder in which tests run scripts: a folder with copies of them and made-up tools."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
NEEDED = ("awk", "bash", "basename", "cp", "dirname", "env", "find", "git", "grep", "head", "id", "mktemp", "nproc", "realpath",
          "rm", "sed", "sort", "tail", "xargs")


class FolderTest(unittest.TestCase):
    """A root with the scripts, and a path that holds nothing but what a test puts there."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.tools = self.root / "tools"
        for name in ("scripts", "src", "tests", "bench", "python", "tools"):
            (self.root / name).mkdir()
        for script in ("check-format", "llvm.sh", "setup.sh", "tidy"):
            shutil.copy(SCRIPTS / script, self.root / "scripts")
        (self.root / "src" / "leaf.cpp").write_text("int leaf;\n", encoding="utf-8")
        for tool in NEEDED:
            (self.tools / tool).symlink_to(shutil.which(tool))

    def tool(self, path, script):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!{shutil.which('bash')}\n{script}\n", encoding="utf-8")
        path.chmod(0o755)

    def llvm_tool(self, name, version, folder=None, then=""):
        """One that notes its arguments in a file of its own name."""
        self.tool((folder or self.tools) / name, f"""
if [ "$1" = --version ]; then echo "Debian {name} version {version}"; exit; fi
echo "$@" >>{self.root}/{name}.calls
{then}""")

    def calls(self, name):
        path = self.root / f"{name}.calls"
        return path.read_text(encoding="utf-8") if path.exists() else ""

    def bash(self, *words):
        return subprocess.run([self.tools / "bash", *words], env={"PATH": str(self.tools)}, capture_output=True, text=True,
                              check=False)
