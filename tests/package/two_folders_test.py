"""The commit that tools/package has made packages of gives the same bytes when it is built again in another folder, from clean,
without a compiler cache."""
import hashlib
import os
import pathlib
import tempfile
import unittest

from packages import NAMES, ROOT, made_packages, need, run

need("git", "cmake", "dpkg-shlibdeps")
MADE = made_packages()


class TwoFolders(unittest.TestCase):
    def test_same_bytes(self):
        with tempfile.TemporaryDirectory(prefix="skyloop-elsewhere-") as folder:
            clone = pathlib.Path(folder) / "some other/place".replace(" ", "-")
            run("git", "clone", "--quiet", "--no-hardlinks", ROOT, clone)
            run("git", "-C", clone, "checkout", "--quiet", "--detach", run("git", "-C", ROOT, "rev-parse", "HEAD").stdout.strip())
            run(clone / "tools/package", timeout=10000, env={**os.environ, "CCACHE_DISABLE": "1"})
            for name in NAMES:
                with self.subTest(name):
                    again = list((clone / "build/packages").glob(f"{name}_*.deb"))
                    self.assertEqual(len(again), 1)
                    self.assertEqual(*(hashlib.sha256(path.read_bytes()).hexdigest() for path in (MADE[name], again[0])))


if __name__ == "__main__":
    unittest.main()
