/// uhid_devices: a relay board of two relays and a CP2110, as the kernel's HID core takes them from user space. The board
/// keeps its relays; the bridge sends back each byte that it is given, and keeps its settings. Every change is told on a line.
/// Layouts: Documentation/hid/uhid.rst; AN434 of Silicon Labs (CP2110); the reports of DCTTECH's relay boards.
#include <errno.h>
#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { RELAY, BRIDGE, DEVICES };

static uint8_t relays;
static uint8_t uart[9] = {0x50, 0, 1, 0xC2, 0, 0, 0, 3, 0};  // 115200 8N1
static uint8_t enabled = 1;

/// A vendor's page: one feature report of eight bytes, no report ids.
static unsigned relay_descriptor(uint8_t* to) {
    static const uint8_t items[] = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF,
                                    0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x00, 0xB2, 0x02, 0x01, 0xC0};
    memcpy(to, items, sizeof items);
    return sizeof items;
}

static unsigned put_report(uint8_t* to, uint8_t id, uint8_t bytes, uint8_t kind) {
    const uint8_t items[] = {0x85, id, 0x95, bytes, 0x09, 0x01, kind, 0x02};
    memcpy(to, items, sizeof items);
    return sizeof items;
}

/// Reports 1 to 63 carry as many bytes both ways; some feature reports set the UART.
static unsigned bridge_descriptor(uint8_t* to) {
    static const uint8_t begin[] = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08};
    static const uint8_t features[][2] = {{0x41, 1}, {0x42, 6}, {0x43, 1}, {0x46, 2}, {0x50, 8}, {0x51, 1}, {0x52, 1}};
    enum { INPUT = 0x81, OUTPUT = 0x91, FEATURE = 0xB1, END = 0xC0 };
    unsigned length = sizeof begin;
    memcpy(to, begin, sizeof begin);
    for (uint8_t id = 1; id <= 63; ++id) {
        length += put_report(to + length, id, id, INPUT);
        length += put_report(to + length, id, id, OUTPUT);
    }
    for (unsigned i = 0; i < sizeof features / sizeof *features; ++i) {
        length += put_report(to + length, features[i][0], features[i][1], FEATURE);
    }
    to[length++] = END;
    return length;
}

static int create(int device) {
    static struct uhid_event event;
    memset(&event, 0, sizeof event);
    event.type = UHID_CREATE2;
    struct uhid_create2_req* made = &event.u.create2;
    made->bus = 3;  // USB
    if (device == RELAY) {
        strcpy((char*)made->name, "USBRelay2");
        made->vendor = 0x16C0;
        made->product = 0x05DF;
        made->rd_size = (uint16_t)relay_descriptor(made->rd_data);
    } else {
        strcpy((char*)made->name, "Silicon Laboratories CP2110 HID USB-to-UART Bridge");
        strcpy((char*)made->uniq, "0001A2B3");
        made->vendor = 0x10C4;
        made->product = 0xEA80;
        made->rd_size = (uint16_t)bridge_descriptor(made->rd_data);
    }
    const int file = open("/dev/uhid", O_RDWR | O_CLOEXEC);
    if (file < 0 || write(file, &event, sizeof event) < 0) {
        printf("/dev/uhid: %s\n", strerror(errno));
        return -1;
    }
    return file;
}

/// `FF n` on, `FD n` off, `FE` all on, `FC` all off.
static void switch_relay(const uint8_t* command) {
    const uint8_t bit = command[1] >= 1 && command[1] <= 2 ? (uint8_t)(1u << (command[1] - 1)) : 0;
    relays = command[0] == 0xFF   ? relays | bit
             : command[0] == 0xFD ? relays & (uint8_t)~bit
             : command[0] == 0xFE ? 3
             : command[0] == 0xFC ? 0
                                  : relays;
    printf("relays %d\n", relays);
}

static void set_bridge(const uint8_t* report) {
    if (report[0] == 0x50) {
        memcpy(uart, report, sizeof uart);
        printf("uart %u parity %d flow %d data %d stop %d\n",
               (unsigned)report[1] << 24 | (unsigned)report[2] << 16 | (unsigned)report[3] << 8 | report[4], report[5],
               report[6], report[7], report[8]);
    } else if (report[0] == 0x41) {
        enabled = report[1];
        printf("enabled %d\n", enabled);
    }
}

static void answer_report(int device, uint8_t asked, struct uhid_get_report_reply_req* reply) {
    if (device == RELAY) {
        // Report id 0, five bytes of serial number, and the relays last.
        static const uint8_t serial[8] = {0, 'S', 'K', 'Y', 'L', 'P', 0, 0};
        memcpy(reply->data, serial, sizeof serial);
        reply->data[8] = relays;
        reply->size = 9;
    } else if (asked == 0x41) {
        reply->data[0] = asked;
        reply->data[1] = enabled;
        reply->size = 2;
    } else if (asked == 0x50) {
        memcpy(reply->data, uart, sizeof uart);
        reply->size = sizeof uart;
    } else {
        reply->err = EIO;
    }
}

static void serve(int device, int file) {
    static struct uhid_event asked, answer;
    if (read(file, &asked, sizeof asked) <= 0) {
        return;
    }
    memset(&answer, 0, sizeof answer);
    if (asked.type == UHID_GET_REPORT) {
        answer.type = UHID_GET_REPORT_REPLY;
        answer.u.get_report_reply.id = asked.u.get_report.id;
        answer_report(device, asked.u.get_report.rnum, &answer.u.get_report_reply);
    } else if (asked.type == UHID_SET_REPORT) {
        answer.type = UHID_SET_REPORT_REPLY;
        answer.u.set_report_reply.id = asked.u.set_report.id;
        if (device == RELAY) {
            switch_relay(asked.u.set_report.data + 1);
        } else {
            set_bridge(asked.u.set_report.data);
        }
    } else if (asked.type == UHID_OUTPUT && device == RELAY) {
        switch_relay(asked.u.output.data + 1);
        return;
    } else if (asked.type == UHID_OUTPUT && asked.u.output.size > 0) {
        answer.type = UHID_INPUT2;
        answer.u.input2.size = asked.u.output.size;
        memcpy(answer.u.input2.data, asked.u.output.data, asked.u.output.size);
    } else {
        return;
    }
    if (write(file, &answer, sizeof answer) < 0) {
        printf("answer: %s\n", strerror(errno));
    }
}

int main(void) {
    setvbuf(stdout, 0, _IOLBF, 0);
    struct pollfd files[DEVICES];
    for (int device = 0; device < DEVICES; ++device) {
        files[device] = (struct pollfd){.fd = create(device), .events = POLLIN};
        if (files[device].fd < 0) {
            return 2;
        }
    }
    printf("ready\n");
    while (poll(files, DEVICES, -1) > 0) {
        for (int device = 0; device < DEVICES; ++device) {
            if (files[device].revents) {
                serve(device, files[device].fd);
            }
        }
    }
    return 0;
}
