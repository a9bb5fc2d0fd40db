"""What the documents say can be done: their links, options, commands and listings.

Blocks marked ```sh are run, each page's in one folder and in order; a ```text block behind one is
its output, whose lines must come up in what is printed, numbers aside. In all blocks the options of
every command must exist.
"""

import importlib.util
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["LOCKSTEP_PROGRAM"]
PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
HAS_MODULES = all(map(importlib.util.find_spec, ("numpy", "matplotlib", "OpenImageIO")))


def text_of(page):
    return page.read_text(encoding="utf-8")


def blocks(page):
    """(language, text) of every fenced block."""
    return BLOCK.findall(text_of(page))


def help_of(*command):
    done = subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


def commands():
    """The names that `lockstep --help` lists."""
    listed = help_of().split("Subcommands:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in listed.splitlines()]


def command_lines(text):
    """The words behind the program's name, of every line of a block that calls it."""
    for line in re.sub(r"\\\n\s*", " ", text).splitlines():
        match = re.match(r"\s*(?:build/release/)?lockstep\s+(.*)", line)
        if match:
            words = shlex.split(match[1], comments=True)
            ends = [i for i, word in enumerate(words) if word in ("|", ">", "&&")]
            yield words[: ends[0]] if ends else words


def without_numbers(text):
    text = re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "#", text)
    return re.sub(r"\s+", " ", text).strip()


class Links(unittest.TestCase):
    def test_lead_to_files(self):
        count = 0
        for page in PAGES:
            for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text_of(page)):
                if "://" not in target:
                    self.assertTrue((page.parent / target).exists(), f"{page.name}: {target}")
                    count += 1
        self.assertGreater(count, 20)

    def test_readme_lists_every_page(self):
        readme = text_of(SOURCE / "README.md")
        for page in PAGES[1:]:
            self.assertIn(f"(docs/{page.name})", readme)

    def test_every_command_has_a_page(self):
        self.assertGreater(len(commands()), 5)
        for command in commands():
            page = SOURCE / "docs" / f"{command}.md"
            self.assertTrue(page.exists(), page)
            shown = [line[0] for _, text in blocks(page) for line in command_lines(text) if line]
            self.assertIn(command, shown, page)


class CommandLines(unittest.TestCase):
    def test_options_exist(self):
        known = {}
        checked = 0
        for page in PAGES:
            for _, text in blocks(page):
                for words in command_lines(text):
                    if not words or words[0].isupper():
                        continue  # COMMAND stands for any
                    checked += self.check_options(page, words, known)
        self.assertGreater(checked, 40)

    def check_options(self, page, words, known):
        if words[0].startswith("-"):
            known.setdefault("", help_of())
            self.assertIn(words[0], known[""], page)
            return 1
        self.assertIn(words[0], commands(), page)
        if words[0] not in known:
            known[words[0]] = help_of(words[0])
        options = [word.split("=")[0] for word in words if re.match(r"--?[a-z]", word)]
        for option in options:
            self.assertRegex(
                known[words[0]], rf"(^|[\s,]){option}[\s,=\[]", f"{page.name}: {words}"
            )
        return len(options)


class Blocks(unittest.TestCase):
    """A test for each page with blocks that are run is added below."""

    def run_page(self, page):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            environment = self.prepare(folder)
            printed = ""
            for language, text in blocks(page):
                if language == "sh":
                    printed = self.run_block(page, text, folder, environment)
                elif language == "text":
                    self.check_output(page, text, printed)

    def prepare(self, folder):
        """Makes the folder look like a clone in which the program was built."""
        (folder / "build/release").mkdir(parents=True)
        (folder / "build/release/lockstep").symlink_to(PROGRAM)
        (folder / "out").mkdir()
        (folder / "bin").mkdir()
        (folder / "bin/lockstep").symlink_to(PROGRAM)
        python = folder / "bin/python3"
        python.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} "$@"\n')
        python.chmod(0o755)
        for name in ("python", "experiments"):
            (folder / name).symlink_to(SOURCE / name)
        return {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}"}

    def run_block(self, page, text, folder, environment):
        if not HAS_MODULES:
            text = "\n".join(line for line in text.splitlines() if not line.startswith("python3"))
        done = subprocess.run(
            ["bash", "-e", "-c", text],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=240,
        )
        self.assertEqual(done.returncode, 0, f"{page.name}: {text}{done.stderr}")
        return done.stdout

    def check_output(self, page, text, printed):
        lines = {without_numbers(line) for line in printed.splitlines()}
        for line in text.splitlines():
            if line.strip() != "...":
                self.assertIn(without_numbers(line), lines, f"{page.name}: {printed}")


def add_tests():
    for page in PAGES:
        if any(language == "sh" for language, _ in blocks(page)):

            def test(self, page=page):
                self.run_page(page)

            setattr(Blocks, f"test_{page.stem.lower()}", test)


add_tests()


class Tutorial(unittest.TestCase):
    def test_listing_is_the_file_that_is_compiled(self):
        listings = [
            text for language, text in blocks(SOURCE / "docs/tutorial.md") if language == "cpp"
        ]
        self.assertIn(text_of(SOURCE / "docs/examples/golden.h"), listings)
        compiled = text_of(SOURCE / "tests/test_example_sequence.cpp")
        self.assertIn('#include "docs/examples/golden.h"', compiled)


@unittest.skipUnless(HAS_MODULES, "numpy, matplotlib or OpenImageIO is missing")
class Python(unittest.TestCase):
    def test_example_runs(self):
        (example,) = (
            text for language, text in blocks(SOURCE / "docs/python.md") if language == "python"
        )
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                [PROGRAM, "compare", "cornell", "--samplers", "random,owen", "--spp", "16"]
                + ["--seeds", "1", "--resolution", "16x12", "--reference-spp", "16"]
                + ["-o", "out/compare", "--quiet"],
                cwd=folder,
                check=True,
                capture_output=True,
                timeout=120,
            )
            done = subprocess.run(
                [sys.executable, "-c", example],
                cwd=folder,
                capture_output=True,
                text=True,
                timeout=60,
            )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"(?m)^random 0\.\d+ ")
        self.assertRegex(done.stdout, r"(?m)^owen 16 \[")


if __name__ == "__main__":
    unittest.main()
