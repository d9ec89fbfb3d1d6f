"""README.md's commands of installation are those that scripts/wheel, package and container run in minimal Debians; the Dockerfile."""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "package"))
import dockerfile  # noqa: E402


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


class Readme(unittest.TestCase):
    commands = [line for block in re.findall(r"^```shell\n(.*?)^```$", text("README.md"), re.M | re.S) for line in block.splitlines()]

    def test_every_command_of_its_installation_is_run(self):
        run = {pattern for name in ("wheel", "package", "container")
               for pattern in re.findall(r'readme_command "([^"]+)"', text(f"scripts/{name}"))}
        self.assertEqual(len(run), 3)
        for command in self.commands:
            if command != "docker build -t frond .":  # whose steps scripts/container runs one by one
                self.assertTrue(any(pattern in command for pattern in run), command)
        for pattern in run:
            found = subprocess.run(["bash", "-c", f"root={ROOT}; source {ROOT}/scripts/bare_debian.sh; readme_command '{pattern}'"],
                                   capture_output=True, text=True, check=True).stdout
            self.assertIn(pattern, found)
            self.assertNotIn("#", found)
            self.assertTrue(any(pattern in command for command in self.commands), pattern)

    def test_the_container_is_called_as_the_dockerfile_says(self):
        steps = dockerfile.steps(text("Dockerfile"))
        self.assertEqual(steps["entry"], ["frond"])
        calls = [line for page in ("README.md", "docs/install.md") for line in text(page).splitlines() if line.startswith("docker run")]
        self.assertEqual(len(calls), 2)
        for call in calls:
            self.assertRegex(call, rf'^docker run --rm --user "\$\(id -u\)" -v "\$PWD:{steps["folder"]}" frond \w+ ')


class Dockerfile(unittest.TestCase):
    def test_steps(self):
        found = dockerfile.steps('# A comment.\nFROM a:1\nLABEL x="y"\nRUN --mount=type=bind,target=/in \\\n    cp /in/x /x && \\\n    true\n'
                                 'ENV A=1\nWORKDIR /w\nENTRYPOINT ["p"]\n')
        self.assertEqual(found, {"base": "a:1", "mount": "/in", "run_commands": ["cp /in/x /x &&  true"], "environment": ["A=1"],
                                 "folder": "/w", "entry": ["p"]})

    def test_what_is_not_run_is_an_error(self):
        for line in ("COPY a b", "FROM b", "RUN --network=none true", "USER x"):
            with self.assertRaises(ValueError, msg=line):
                dockerfile.steps(f"FROM a\n{line}\n")


if __name__ == "__main__":
    unittest.main()
