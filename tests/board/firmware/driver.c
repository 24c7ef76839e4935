#include "driver.h"

#include "board.h"
#include "messages.h"
#include "parser.h"

enum {
    ANSWER_MS = 350,  // for MON-VER, as Betaflight waits
    ACK_MS = 300,     // PX4 waits 250 ms, INAV a second
    TRIES = 4,
    LOST_MS = 2500,  // Betaflight gives a receiver up after this
    COUNTS_MS = 5000,
    WORKING_BAUD = 115200,
    PERIOD_MS = 200,
    FIRST_KEYS_PROTOCOL = 2301,  // CFG-VALSET exists from protocol version 23.01 on
};

static const uint32_t hunted_bauds[] = {115200, 38400, 9600, 57600, 230400};

static Parser parser;
static uint8_t frame[8 + PAYLOAD_BYTES];
static uint32_t frames, bad_frames, sentences, bad_sentences, last_solution_ms;
static int32_t protocol_version;  // times 100; 0: not told
static bool version_told, has_fix;
static uint16_t answered_message;  // by ACK-ACK or ACK-NAK
static bool refused;

static void report(const char* word, int32_t value) {
    report_text(word);
    report_number(value);
    report_end();
}

static void solution(void) {
    const Solution now = solution_of(parser.payload);
    last_solution_ms = milliseconds();
    report_text("pvt");
    for (unsigned i = 0; i < SOLUTION_VALUES; ++i) {
        report_number(now.values[i]);
    }
    report_end();
    if (now.good != has_fix) {
        has_fix = now.good;
        report_text(has_fix ? "fix" : "no_fix");
        report_end();
    }
}

static void frame_heard(void) {
    const uint16_t message = (uint16_t)(parser.message_class << 8 | parser.message_id);
    if (message == NAV_PVT && (parser.length == 92 || parser.length == 84)) {
        solution();
    } else if (message == MON_VER && parser.length >= 40) {
        version_told = true;
        protocol_version = protocol_of(parser.payload, parser.length);
    } else if ((message == ACK_ACK || message == ACK_NAK) && parser.length == 2) {
        answered_message = (uint16_t)(parser.payload[0] << 8 | parser.payload[1]);
        refused = message == ACK_NAK;
    }
}

static void sentence_heard(void) {
    int32_t values[GGA_VALUES];
    if (gga_of(&parser, values)) {
        report_text("gga");
        for (unsigned i = 0; i < GGA_VALUES; ++i) {
            report_number(values[i]);
        }
        report_end();
    }
}

static void listen(void) {
    for (int byte = receiver_byte(); byte >= 0; byte = receiver_byte()) {
        switch (parser_take(&parser, (uint8_t)byte)) {
            case UBX_FRAME:
                ++frames;
                frame_heard();
                break;
            case NMEA_SENTENCE:
                ++sentences;
                sentence_heard();
                break;
            case BAD_FRAME:
                ++bad_frames;
                break;
            case BAD_SENTENCE:
                ++bad_sentences;
                break;
            default:
                break;
        }
    }
}

static void send(uint16_t message, const uint8_t* payload, unsigned length) {
    receiver_send(frame, ubx_frame(frame, message, payload, length));
}

/// Asks for the version a few times.
static bool answers(unsigned tries) {
    version_told = false;
    for (unsigned i = 0; i < tries && !version_told; ++i) {
        send(MON_VER, 0, 0);
        const uint32_t asked = milliseconds();
        while (!version_told && milliseconds() - asked < ANSWER_MS) {
            rest();
            listen();
        }
    }
    return version_told;
}

/// Gives the speed at which a receiver answers, or 0 after one round.
static uint32_t hunt(void) {
    for (unsigned i = 0; i < sizeof hunted_bauds / sizeof *hunted_bauds; ++i) {
        const uint32_t before = sentences;
        receiver_line_speed(hunted_bauds[i]);
        if (answers(3)) {
            report_text("found");
            report_number((int32_t)hunted_bauds[i]);
            report_number(protocol_version);
            report_end();
            return hunted_bauds[i];
        }
        if (sentences - before > 1) {
            report_text("mute");
            report_number((int32_t)hunted_bauds[i]);
            report_number((int32_t)(sentences - before));
            report_end();
        }
    }
    report("nobody", (int32_t)receiver_bytes_heard());
    return 0;
}

/// Sends a setting until it is answered; gives whether it was accepted.
static bool set(const Setting* setting) {
    for (unsigned i = 1; i <= TRIES; ++i) {
        answered_message = 0;
        send(setting->message, setting->payload, setting->length);
        const uint32_t sent = milliseconds();
        while (answered_message != setting->message && milliseconds() - sent < ACK_MS) {
            rest();
            listen();
        }
        if (answered_message == setting->message) {
            report_text(refused ? "nak" : "ack");
            report_number(setting->message);
            report_number((int32_t)(milliseconds() - sent));
            report_number((int32_t)i);
            report_end();
            return !refused;
        }
    }
    report("silent", setting->message);
    return false;
}

/// The answer to a change of speed may be lost between the two speeds: asking again at the new one tells.
static bool change_speed(uint32_t baud, bool by_keys) {
    if (baud == WORKING_BAUD) {
        return true;
    }
    const Setting setting = speed_setting(WORKING_BAUD, by_keys);
    send(setting.message, setting.payload, setting.length);
    receiver_line_speed(WORKING_BAUD);
    if (!answers(TRIES)) {
        return false;
    }
    report("speed", WORKING_BAUD);
    return true;
}

static bool configure(uint32_t baud) {
    const bool by_keys = protocol_version >= FIRST_KEYS_PROTOCOL;
    if (!change_speed(baud, by_keys)) {
        return false;
    }
    for (unsigned i = 0; i < setting_count(by_keys); ++i) {
        const Setting setting = setting_number(i, PERIOD_MS, by_keys);
        if (!set(&setting)) {
            return false;
        }
    }
    return true;
}

static void report_counts(void) {
    report_text("counts");
    report_number((int32_t)frames);
    report_number((int32_t)bad_frames);
    report_number((int32_t)sentences);
    report_number((int32_t)bad_sentences);
    report_number((int32_t)receiver_bytes_heard());
    report_number((int32_t)receiver_bytes_lost());
    report_end();
}

/// Until the receiver has been silent for too long.
static void follow(void) {
    uint32_t counted = milliseconds();
    last_solution_ms = milliseconds();
    while (milliseconds() - last_solution_ms < LOST_MS) {
        rest();
        listen();
        if (milliseconds() - counted >= COUNTS_MS) {
            counted += COUNTS_MS;
            report_counts();
        }
    }
    report("lost", (int32_t)(milliseconds() - last_solution_ms));
    if (has_fix) {
        has_fix = false;
        report_text("no_fix");
        report_end();
    }
}

_Noreturn void drive(void) {
    for (int32_t round = 1;; ++round) {
        report("hunt", round);
        const uint32_t baud = hunt();
        if (baud && configure(baud)) {
            report("ready", (int32_t)milliseconds());
            follow();
        }
        report_counts();
    }
}
