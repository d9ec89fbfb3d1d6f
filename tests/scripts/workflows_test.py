"""The workflows of .github, which run on GitHub alone: their actions are pinned, jobs have only the permissions that their actions need,
and each step is a command of scripts/ with options that it has.

usage: workflows_test.py --run WORKFLOW JOB: runs the steps of a job that are commands, in the present clone. GITHUB_REF_NAME and
others are taken from the environment."""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
GITHUB = ROOT / ".github"
# Before a checkout in a container of Debian, which has no Git, and after it, for its owner..
PREPARES = re.compile(r"apt-get update -qq && apt-get install -y -qq --no-install-recommends git ca-certificates( python3)?"
                      r'|git config --global --add safe\.directory "\$GITHUB_WORKSPACE"')
NEEDS = {
    "actions/checkout": {"contents": "read"},
    "actions/attest-build-provenance": {"id-token": "write", "attestations": "write"},
    "actions/deploy-pages": {"pages": "write", "id-token": "write"},
    "docker/build-push-action": {"packages": "write"},
    "github/codeql-action/analyze": {"security-events": "write"},
    "pypa/gh-action-pypi-publish": {"id-token": "write"},
    "softprops/action-gh-release": {"contents": "write"},
}


def workflows():
    for path in sorted((GITHUB / "workflows").glob("*.yml")):
        yield path.name, yaml.safe_load(path.read_text(encoding="utf-8"))


def steps():
    for name, workflow in workflows():
        for job in workflow["jobs"].values():
            for step in job["steps"]:
                yield name, step


def scripts_command(line):
    """The script and its options, which may be followed by values; an error if they are not a script's."""
    words = shlex.split(line)
    script = ROOT / words[0]
    if words[0].split("/")[0] != "scripts" or not os.access(script, os.X_OK):
        raise ValueError(f"{line}: no script")
    text = script.read_text(encoding="utf-8")
    for word in words[1:]:
        # A pattern of the script's case statements.
        if word.startswith("-") and not re.search(rf"^\s*(?:\S+ \| )*{re.escape(word)}(?: \| \S+)*\)", text, re.M):
            raise ValueError(f"{line}: {words[0]} has no {word}")
    return words


class Workflows(unittest.TestCase):
    def test_steps_are_commands_of_scripts(self):
        count = 0
        for name, step in steps():
            if "run" in step and not PREPARES.fullmatch(step["run"]):
                scripts_command(step["run"])
                # GitHub would paste the value into the shell's text.
                self.assertNotIn("${{", step["run"], name)
                count += 1
        self.assertGreater(count, 5)

    def test_an_unknown_option_or_script_is_found(self):
        for line in ("scripts/test --fast", "scripts/nothing", "make", "scripts/setup.sh", "scripts/package --suites x"):
            with self.assertRaises(ValueError, msg=line):
                scripts_command(line)

    def test_actions_are_pinned_to_commits(self):
        for path in (GITHUB / "workflows").glob("*.yml"):
            uses = re.findall(r"^\s*(?:- )?uses: (.*)$", path.read_text(encoding="utf-8"), re.M)
            self.assertTrue(uses, path.name)
            for action in uses:
                self.assertRegex(action, r"^[\w-]+/[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+$", path.name)

    def test_one_version_of_each_action(self):
        versions = {}
        for _, step in steps():
            if "uses" in step:
                action, commit = step["uses"].split("@")
                self.assertEqual(versions.setdefault(action, commit), commit, action)

    def test_jobs_have_the_permissions_that_their_actions_need(self):
        for name, workflow in workflows():
            self.assertIn(workflow["permissions"], ({}, {"contents": "read"}), name)
            for key, job in workflow["jobs"].items():
                needed = {}
                for step in job["steps"]:
                    needed |= NEEDS.get(step.get("uses", "").split("@")[0], {})
                self.assertEqual(job.get("permissions", workflow["permissions"]), needed, f"{name}, {key}")

    def test_checkouts_keep_no_credentials_and_jobs_end(self):
        for name, workflow in workflows():
            self.assertIn("concurrency", workflow, name)
            for key, job in workflow["jobs"].items():
                self.assertIn("timeout-minutes", job, f"{name}, {key}")
                self.assertLessEqual({job["needs"]} if "needs" in job else set(), set(workflow["jobs"]), f"{name}, {key}")
                for step in job["steps"]:
                    if step.get("uses", "").startswith("actions/checkout@"):
                        self.assertIs(step["with"]["persist-credentials"], False, f"{name}, {key}")

    def test_only_a_tag_publishes_a_release(self):
        release = dict(workflows())["release.yml"]
        self.assertEqual(release[True], {"push": {"tags": ["v*"]}})  # YAML 1.1 reads the key `on` as true
        commands = [step["run"] for step in release["jobs"]["build"]["steps"] if "run" in step]
        self.assertEqual(commands[-2:], ['scripts/package --check "$GITHUB_REF_NAME"', "scripts/package --all"])
        for key in release["jobs"].keys() - {"build"}:
            self.assertEqual(release["jobs"][key]["needs"], "build", key)


class Templates(unittest.TestCase):
    def test_folders_of_dependabot_have_files_for_it(self):
        files = {"github-actions": ".github/workflows/test.yml", "pip": "requirements.txt", "docker": "Dockerfile"}
        for update in yaml.safe_load((GITHUB / "dependabot.yml").read_text(encoding="utf-8"))["updates"]:
            self.assertTrue((ROOT / update["directory"].strip("/") / files[update["package-ecosystem"]]).is_file(), update)

    def test_forms_of_issues_are_complete(self):
        for path in (GITHUB / "ISSUE_TEMPLATE").glob("*.yml"):
            form = yaml.safe_load(path.read_text(encoding="utf-8"))
            if path.name == "config.yml":
                continue
            self.assertLessEqual({"name", "description", "body"}, set(form), path.name)
            fields = [field for field in form["body"] if field["type"] != "markdown"]
            self.assertEqual(len({field["id"] for field in fields}), len(fields), path.name)
            for field in fields:
                self.assertIn("label", field["attributes"], path.name)


def run(workflow, job):
    for step in dict(workflows())[workflow]["jobs"][job]["steps"]:
        if "run" in step and not PREPARES.fullmatch(step["run"]):
            print(f"$ {step['run']}", flush=True)
            subprocess.run(["bash", "-e", "-o", "pipefail", "-c", step["run"]], cwd=ROOT, check=True)
        elif "uses" in step:
            print(f"left out: {step['uses'].split('@')[0]} {step.get('with', '')}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--run"]:
        run(*sys.argv[2:])
    else:
        unittest.main()
