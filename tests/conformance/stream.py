"""What parsers of a client's stream have in common."""


class StreamParser:
    """Keeps what is not whole yet; `take` of a parser puts what stands at the front of the buffer into the items, and tells
    how many bytes that took: none while it is not whole."""

    def __init__(self):
        self.buffer = b""

    def clear(self):
        self.buffer = b""

    def feed(self, data, at=0.0):
        self.buffer += data
        items = []
        while self.buffer:
            used = self.take(at, items)
            if used == 0:
                break
            self.buffer = self.buffer[used:]
        return items
