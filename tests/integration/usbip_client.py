"""A USB/IP client (Linux kernel, Documentation/usb/usbip_protocol) with what a kernel's cdc_acm driver does."""
import select
import socket
import struct
import time

VERSION, REQUEST_IMPORT, REQUEST_LIST = 0x0111, 0x8003, 0x8005
SUBMIT, UNLINK, RETURN_SUBMIT, RETURN_UNLINK = 1, 2, 3, 4
STALLED, UNLINKED = -32, -104
DEVICE_BYTES = 312
DATA_IN, DATA_OUT, NOTIFY = 2, 1, 3


def connect(address):
    """A connection to "host:port"."""
    host, port = address.rsplit(":", 1)
    connection = socket.create_connection((host.strip("[]"), int(port)), timeout=20)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def receive(connection, count):
    """Exactly so many bytes."""
    data = b""
    while len(data) < count:
        piece = connection.recv(count - len(data))
        if not piece:
            raise EOFError("the server has closed")
        data += piece
    return data


def parse_device(record):
    """The fields of a device record."""
    names = ("bus", "number", "speed", "vendor", "product", "release", "device_class", "subclass", "protocol", "configuration",
             "configurations", "interfaces")
    fields = dict(zip(names, struct.unpack(">IIIHHHBBBBBB", record[288:])))
    return fields | {"path": record[:256].rstrip(b"\0").decode(), "bus_id": record[256:288].rstrip(b"\0").decode()}


def listed(address):
    """What OP_REQ_DEVLIST gives: devices with the classes of their interfaces."""
    with connect(address) as connection:
        connection.sendall(struct.pack(">HHI", VERSION, REQUEST_LIST, 0))
        version, code, status, count = struct.unpack(">HHII", receive(connection, 12))
        assert (version, code, status) == (VERSION, 5, 0), (version, code, status)
        devices = []
        for _ in range(count):
            device = parse_device(receive(connection, DEVICE_BYTES))
            device["classes"] = [tuple(receive(connection, 4)[:3]) for _ in range(device["interfaces"])]
            devices.append(device)
        assert connection.recv(1) == b"", "the server closes after the list"
        return devices


class ImportRefused(Exception):
    """The status of OP_REP_IMPORT."""


class Host:
    """An imported device. Transfers are submitted and their answers collected by sequence number."""

    def __init__(self, address, bus_id="1-1"):
        self.connection = connect(address)
        try:
            self.connection.sendall(struct.pack(">HHI32s", VERSION, REQUEST_IMPORT, 0, bus_id.encode()))
            _, code, status = struct.unpack(">HHI", receive(self.connection, 8))
            assert code == 3, code
            if status != 0:
                raise ImportRefused(status)
            self.device = parse_device(receive(self.connection, DEVICE_BYTES))
        except BaseException:
            self.connection.close()
            raise
        self.id = self.device["bus"] << 16 | self.device["number"]
        self.sequence = 0
        self.to_host = {}  # sequence number: whether data come back
        self.answers = {}  # sequence number: (status, length, data)
        self.unlinked = {}
        self.polls = set()
        self.heard = bytearray()

    def submit(self, endpoint, to_host, length, setup=bytes(8), data=b""):
        """Gives the sequence number."""
        self.sequence += 1
        self.to_host[self.sequence] = to_host
        self.connection.sendall(struct.pack(">IIIIIIiiii", SUBMIT, self.sequence, self.id, int(to_host), endpoint, 0, length, 0, -1,
                                            0) + setup + data)
        return self.sequence

    def unlink(self, target):
        """Cancels a transfer; gives the status once it is told."""
        self.sequence += 1
        mine = self.sequence
        self.connection.sendall(struct.pack(">IIIIII24x", UNLINK, mine, self.id, 0, 0, target))
        while mine not in self.unlinked:
            self.take_answer()
        return self.unlinked.pop(mine)

    def take_answer(self):
        """Waits for the next message of the server."""
        header = receive(self.connection, 48)
        command, sequence, device, direction, endpoint, status, length = struct.unpack(">IIIIIii", header[:28])
        assert (device, direction, endpoint) == (0, 0, 0)
        if command == RETURN_UNLINK:
            self.unlinked[sequence] = status
            return
        assert command == RETURN_SUBMIT, command
        data = receive(self.connection, length) if self.to_host.pop(sequence) and status == 0 else b""
        if sequence in self.polls:
            self.polls.remove(sequence)
            assert status == 0, status
            self.heard += data
            return
        self.answers[sequence] = (status, length, data)

    def wait_for(self, sequence):
        """(status, length, data) of a transfer."""
        while sequence not in self.answers:
            self.take_answer()
        return self.answers.pop(sequence)

    def control(self, kind, request, value=0, index=0, length=0, data=b""):
        """Gives (status, data) of a control transfer."""
        to_host = bool(kind & 0x80)
        length = length if to_host else len(data)
        setup = struct.pack("<BBHHH", kind, request, value, index, length)
        status, _, answer = self.wait_for(self.submit(0, to_host, length, setup, data))
        return status, answer

    def read_descriptor(self, kind, index=0, length=255):
        """GET_DESCRIPTOR."""
        return self.control(0x80, 6, kind << 8 | index, 0x0409 if kind == 3 else 0, length)

    def text(self, index):
        """A string descriptor's text."""
        status, data = self.read_descriptor(3, index)
        assert status == 0 and data[1] == 3 and data[0] == len(data)
        return data[2:].decode("utf-16le")

    def enumerate(self):
        """As a kernel enumerates and cdc_acm probes; gives device and configuration descriptors and texts."""
        device = self.read_descriptor(1, 0, 18)[1]
        total = struct.unpack("<H", self.read_descriptor(2, 0, 9)[1][2:4])[0]
        configuration = self.read_descriptor(2, 0, total)[1]
        texts = [self.text(i) for i in device[14:17] if i]
        assert self.control(0x00, 9, 1) == (0, b""), "SET_CONFIGURATION"
        self.set_line(9600)
        return device, configuration, texts

    def set_line(self, baud, stop=0, parity=0, bits=8):
        """SET_LINE_CODING."""
        assert self.control(0x21, 0x20, data=struct.pack("<IBBB", baud, stop, parity, bits)) == (0, b"")

    def set_lines(self, state):
        """SET_CONTROL_LINE_STATE: 1 DTR, 2 RTS."""
        assert self.control(0x21, 0x22, state) == (0, b"")

    def open(self, polls=16):
        """As a program opens the terminal: DTR and RTS, and transfers that wait for data."""
        self.wanted = polls
        self.set_lines(3)
        self.poll()

    def poll(self):
        """Keeps transfers of data waiting."""
        while len(self.polls) < self.wanted:
            self.polls.add(self.submit(DATA_IN, True, 128))

    def close_terminal(self):
        """As a program closes it: DTR falls, and each transfer that waits is cancelled."""
        self.set_lines(0)
        for sequence in sorted(self.polls):
            if sequence in self.polls and self.unlink(sequence) == UNLINKED:
                self.polls.remove(sequence)
                del self.to_host[sequence]

    def write(self, data):
        """Sends serial bytes, as many transfers as a driver needs."""
        for at in range(0, len(data), 1280):
            piece = data[at:at + 1280]
            assert self.wait_for(self.submit(DATA_OUT, False, len(piece), data=piece)) == (0, len(piece), b"")

    def read_for(self, seconds):
        """Serial bytes of some seconds; ends early when the server closes."""
        end = time.monotonic() + seconds
        try:
            while (left := end - time.monotonic()) > 0:
                if select.select([self.connection], [], [], left)[0]:
                    self.take_answer()
                    self.poll()
        except (EOFError, ConnectionResetError, BrokenPipeError):
            pass
        data, self.heard = bytes(self.heard), bytearray()
        return data

    def detach(self):
        """Pulls the plug."""
        self.connection.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.connection.close()
