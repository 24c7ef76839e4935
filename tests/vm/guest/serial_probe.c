/// serial_probe DEVICE SPEED SECONDS [EPOCHS]: reads a tty as a client does, raw, 8N1, at any speed, with DTR and RTS, and
/// asks for UBX-MON-VER once a second. Ends after so many seconds, or once so many sentences GGA were heard, and tells on one
/// line what it heard: whole sentences, broken ones, answers, times of day that did not follow each other by `step`.
/// Exit code 2: the device cannot be opened or set.
#include <asm/termbits.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

enum { LINE = 256, ANSWER_HEAD = 4 };

static char line[LINE];
static int length;
static bool inside;
static long bytes, sentences, broken, answers, asked, epochs, gaps;
static double first_time = -1, last_time = -1, step;
static unsigned char tail[ANSWER_HEAD];

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static int open_line(const char* device, unsigned speed) {
    const int line_descriptor = open(device, O_RDWR | O_NOCTTY | O_NONBLOCK);
    struct termios2 settings;
    if (line_descriptor < 0 || ioctl(line_descriptor, TCGETS2, &settings) < 0) {
        return -1;
    }
    settings.c_iflag = settings.c_oflag = settings.c_lflag = 0;
    settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
    settings.c_ispeed = settings.c_ospeed = speed;
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    if (ioctl(line_descriptor, TCSETS2, &settings) < 0) {
        return -1;
    }
    // What came before went through a line discipline that changes line ends.
    return ioctl(line_descriptor, TCFLSH, TCIFLUSH) < 0 ? -1 : line_descriptor;
}

/// A sentence without `$`, from the address to the checksum.
static bool sound(void) {
    unsigned sum = 0, told;
    const char* star = memchr(line, '*', (size_t)length);
    if (!star || sscanf(star + 1, "%2X", &told) != 1 || star + 3 != line + length) {
        return false;
    }
    for (const char* at = line; at < star; ++at) {
        sum ^= (unsigned char)*at;
    }
    return sum == told;
}

static void epoch(void) {
    const double clock = atof(line + 6);
    const int whole = (int)clock;
    const double time = whole / 10000 * 3600 + whole / 100 % 100 * 60 + whole % 100 + (clock - whole);
    if (epochs == 1) {
        step = time - last_time;
    } else if (epochs > 1) {
        const double difference = time - last_time - step;
        gaps += difference > 0.001 || difference < -0.001;
    }
    if (epochs++ == 0) {
        first_time = time;
    }
    last_time = time;
}

static void heard(unsigned char byte) {
    static const unsigned char head[ANSWER_HEAD] = {0xB5, 0x62, 0x0A, 0x04};
    ++bytes;
    memmove(tail, tail + 1, ANSWER_HEAD - 1);
    tail[ANSWER_HEAD - 1] = byte;
    answers += memcmp(tail, head, ANSWER_HEAD) == 0;
    if (byte == '$') {
        broken += inside;
        inside = true;
        length = 0;
    } else if (inside && (byte == '\r' || length == LINE - 1)) {
        inside = false;
        line[length] = 0;
        if (sound()) {
            ++sentences;
            if (strncmp(line + 2, "GGA,", 4) == 0) {
                epoch();
            }
        } else {
            ++broken;
        }
    } else if (inside) {
        line[length++] = (char)byte;
    }
}

static const char* listen_until(int descriptor, double end, long wanted) {
    static const unsigned char poll_version[] = {0xB5, 0x62, 0x0A, 0x04, 0, 0, 0x0E, 0x34};
    unsigned char data[4096];
    double ask = seconds() + 0.5;
    while (seconds() < end && (wanted == 0 || epochs < wanted)) {
        struct pollfd ready = {.fd = descriptor, .events = POLLIN};
        if (seconds() >= ask) {
            ask += 1;
            asked += write(descriptor, poll_version, sizeof poll_version) == (ssize_t)sizeof poll_version;
        }
        if (poll(&ready, 1, 100) <= 0) {
            continue;
        }
        const ssize_t count = read(descriptor, data, sizeof data);
        if (count == 0 || (count < 0 && errno != EAGAIN)) {
            return count == 0 ? "hung up" : strerror(errno);
        }
        for (ssize_t i = 0; i < count; ++i) {
            heard(data[i]);
        }
    }
    return "-";
}

int main(int count, char** arguments) {
    if (count < 4) {
        fprintf(stderr, "usage: serial_probe DEVICE SPEED SECONDS [EPOCHS]\n");
        return 2;
    }
    const int descriptor = open_line(arguments[1], (unsigned)atoi(arguments[2]));
    if (descriptor < 0) {
        printf("%s: %s\n", arguments[1], strerror(errno));
        return 2;
    }
    const double began = seconds();
    const char* ended = listen_until(descriptor, began + atof(arguments[3]), count > 4 ? atol(arguments[4]) : 0);
    int modem = 0;
    if (ioctl(descriptor, TIOCMGET, &modem) < 0) {
        modem = -1;
    }
    printf("bytes=%ld sentences=%ld broken=%ld asked=%ld answers=%ld epochs=%ld step=%.2f gaps=%ld first=%.2f last=%.2f "
           "modem=%d seconds=%.1f ended=%s\n",
           bytes, sentences, broken, asked, answers, epochs, step, gaps, first_time, last_time, modem, seconds() - began,
           ended);
    return 0;
}
