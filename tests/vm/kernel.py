"""Debian's kernel for the virtual machine: one that is installed, or a package in the cache folder, unpacked once.

The cloud kernels lack USB and are passed over. tools/fetch_kernel puts a package into the cache folder.
"""
import os
import pathlib
import re
import shutil
import subprocess

CACHE = pathlib.Path(os.environ.get("SKYLOOP_KERNEL_CACHE") or
                     pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache", "skyloop/kernel"))
NEEDED = "kernel/drivers/usb/class/cdc-acm.ko"
# What the package is unpacked for; the whole of it takes 400 MB.
PARTS = ["./boot/vmlinuz-*", "./lib/modules/*/modules.*", "./lib/modules/*/kernel/drivers/usb/*",
         "./lib/modules/*/kernel/drivers/hid/*", "./lib/modules/*/kernel/drivers/net/*virtio*",
         "./lib/modules/*/kernel/drivers/virtio/*", "./lib/modules/*/kernel/net/core/*",
         "./lib/modules/*/kernel/drivers/net/net_failover.ko"]


class Kernel:
    """An image and the folder that holds lib/modules/RELEASE."""

    def __init__(self, image, root):
        self.image, self.root = pathlib.Path(image), pathlib.Path(root)
        self.release = self.image.name.removeprefix("vmlinuz-")

    def modules(self):
        return self.root / "lib/modules" / self.release

    def with_dependencies(self, *names):
        """The files of these modules and of all that they need, those that are built in left out."""
        files = {}
        for name in names:
            done = subprocess.run([tool("modprobe"), "-d", self.root, "-S", self.release, "--show-depends", name],
                                  capture_output=True, text=True, timeout=60)
            if done.returncode != 0:
                raise AssertionError(f"module {name} of {self.release}: {done.stderr.strip()}")
            for line in done.stdout.splitlines():
                if line.startswith("insmod "):
                    files[pathlib.Path(line.split()[1])] = None
        return list(files)


def tool(name):
    """A program of the administrator, whose folder is not in every PATH."""
    found = shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    return found or name


def is_usable(kernel):
    return kernel.image.is_file() and os.access(kernel.image, os.R_OK) and (kernel.modules() / NEEDED).is_file()


def by_version(path):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", path.name)]


def installed():
    """The newest kernel of this machine that has its modules, or None."""
    images = sorted(pathlib.Path("/boot").glob("vmlinuz-*-amd64"), key=by_version, reverse=True)
    found = (Kernel(image, "/") for image in images if "cloud" not in image.name)
    return next(filter(is_usable, found), None)


def unpacked(folder):
    """The newest package of the cache folder, unpacked into `folder` unless it is there; None without a package."""
    packages = [path for path in CACHE.glob("linux-image-*-amd64_*.deb") if "cloud" not in path.name and "-dbg_" not in path.name]
    if not packages:
        return None
    package = max(packages, key=by_version)
    root = pathlib.Path(folder, package.stem)
    if not root.is_dir():
        unfinished = pathlib.Path(f"{root}.{os.getpid()}")
        shutil.rmtree(unfinished, ignore_errors=True)
        unfinished.mkdir(parents=True)
        unpack(package, unfinished)
        unfinished.rename(root)
    image, = root.glob("boot/vmlinuz-*")
    return Kernel(image, root)


def unpack(package, folder):
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE) as archive:
        # tar ends with 2 when a part is in no package of this version; what is needed is asked for afterwards.
        subprocess.run(["tar", "--extract", "--wildcards", "--directory", folder, *PARTS], stdin=archive.stdout,
                       stderr=subprocess.DEVNULL, timeout=120, check=False)
        archive.communicate(timeout=120)
    image = next(folder.glob("boot/vmlinuz-*"), None)
    if image is None or not is_usable(Kernel(image, folder)):
        raise AssertionError(f"{package} holds no kernel with {NEEDED}")
    # The package's own scripts would do this.
    subprocess.run([tool("depmod"), "-b", folder, Kernel(image, folder).release], timeout=60, check=True)


def find(folder):
    """A kernel to start, or None."""
    return installed() or unpacked(folder)
