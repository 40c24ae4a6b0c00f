# SPDX-License-Identifier: Apache-2.0
"""What the end-to-end tests share: a test case with an empty folder of its own, and ways to call the program in it."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ.get("WELKIN", "welkin")

# The smallest picture that still has a sky in it: the tests must not need a GPU.
TINY = ["--size", "96x54", "--quality", "low"]
CUMULUS = ["--metar", "LSZH 211220Z 24008KT 9999 SCT040 22/12 Q1018", "--place", "47.46,8.55,430",
           "--time", "2026-06-21T12:20:00Z"]


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="welkin-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, *args, stdin=b"", **environment):
        """Calls the program in the test's folder; everything is bytes, since messages may quote any."""
        env = {**os.environ, **environment}
        return subprocess.run([PROGRAM, *args], cwd=self.folder, env=env, input=stdin, capture_output=True, timeout=300)

    def succeed(self, *args, **environment):
        done = self.run_program(*args, **environment)
        self.assertEqual(done.returncode, 0, done.stderr.decode(errors="replace"))
        self.assertEqual(done.stderr, b"", "quiet when standard error is not a terminal")
        return done.stdout.decode()

    def fail_with(self, code, message, *args, **environment):
        """The call fails with this exit code and one line that holds `message`, and leaves no new file behind."""
        before = self.files()
        done = self.run_program(*args, **environment)
        stderr = done.stderr.decode(errors="replace")
        self.assertEqual(done.returncode, code, stderr)
        self.assertTrue(stderr.startswith("welkin: "), stderr)
        self.assertEqual(stderr.count("\n"), 1, stderr)
        self.assertIn(message, stderr)
        self.assertEqual(self.files(), before, "left something behind")
        return stderr

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def files(self):
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*"))


def main():
    sys.exit(0 if unittest.main(exit=False, verbosity=2).result.wasSuccessful() else 1)
