"""What a process holds, looked at again and again, and whether that grows."""
import dataclasses
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
from session import SKYLOOP, held_by, open_folder, septentrio_that_sends, skyloop  # noqa: E402,F401  (for those who import us)

FEWEST = 9  # looks that tell anything of growth
SLACK_KB = 2048


def thirds(looks, figure):
    """That figure of the middle third, and of the last one."""
    third = len(looks) // 3
    return figure(looks[third:2 * third]), figure(looks[2 * third:])


@dataclasses.dataclass
class Growth:
    """Looks at a process until it has ended; the first third of them is its start."""
    pid: int
    resident_kb: list = dataclasses.field(default_factory=list)
    descriptors: list = dataclasses.field(default_factory=list)

    def look(self):
        """Notes what it holds now; nothing of one that has just ended."""
        held = held_by(self.pid)
        if held is None:
            return
        self.resident_kb.append(held[0])
        self.descriptors.append(held[1])

    def memory(self):
        """The most of the middle third, and of the last one."""
        return thirds(self.resident_kb, max)

    def files(self):
        """The usual of the middle third, and of the last one: one that is being replaced is open twice for a moment."""
        return thirds(self.descriptors, statistics.median_low)

    def fault(self):
        """What has grown, in words; nothing if all is flat, or if there were too few looks to tell."""
        if len(self.resident_kb) < FEWEST:
            return ""
        before, after = self.memory()
        if after > before + SLACK_KB + before // 50:
            return f"resident memory grew from {before} to {after} kB"
        before, after = self.files()
        return f"open files grew from {before} to {after}" if after > before else ""

    def __str__(self):
        if len(self.resident_kb) < FEWEST:
            return f"{len(self.resident_kb)} looks"
        memory, files = self.memory(), self.files()
        return (f"{memory[0]} kB and {files[0]} files in the middle third, {memory[1]} kB and {files[1]} in the last "
                f"({len(self.resident_kb)} looks)")
