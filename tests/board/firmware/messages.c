#include "messages.h"

static void put_u4(Setting* setting, uint32_t value) {
    for (unsigned i = 0; i < 4; ++i) {
        setting->payload[setting->length++] = (uint8_t)(value >> 8 * i);
    }
}

static void put_u2(Setting* setting, uint16_t value) {
    setting->payload[setting->length++] = (uint8_t)value;
    setting->payload[setting->length++] = (uint8_t)(value >> 8);
}

static void put_u1(Setting* setting, uint8_t value) { setting->payload[setting->length++] = value; }

Solution solution_of(const uint8_t* nav_pvt) {
    // lon, lat, height, hMSL, hAcc, vAcc, velN, velE, velD follow each other from offset 24 on.
    Solution solution = {.values = {i4(nav_pvt), nav_pvt[20], nav_pvt[21], nav_pvt[23]}};
    for (unsigned i = 4; i < SOLUTION_VALUES; ++i) {
        solution.values[i] = i4(nav_pvt + 24 + 4 * (i - 4));
    }
    solution.good = (nav_pvt[21] & 1) && (nav_pvt[20] == 2 || nav_pvt[20] == 3);
    return solution;
}

int32_t protocol_of(const uint8_t* mon_ver, unsigned length) {
    static const char key[] = "PROTVER";
    enum { KEY = sizeof key - 1, EXTENSION = 30 };
    for (unsigned at = 40; at + EXTENSION <= length; at += EXTENSION) {
        unsigned same = 0;
        while (same < KEY && mon_ver[at + same] == (uint8_t)key[same]) {
            ++same;
        }
        int32_t version = 0;
        // `=` or, in old firmware, a space stands between. The extension ends with a zero.
        if (same == KEY && mon_ver[at + EXTENSION - 1] == 0 &&
            fixed_point((const char*)mon_ver + at + KEY + 1, 2, &version)) {
            return version;
        }
    }
    return 0;
}

/// `ddmm.mmmmm` as 1e-5 minutes.
static bool minutes_of(const char* field, const char* side, char negative, int32_t* value) {
    enum { MINUTE = 100000 };
    if (!fixed_point(field, 5, value)) {
        return false;
    }
    const int32_t degrees = *value / (100 * MINUTE);
    *value = degrees * 60 * MINUTE + *value % (100 * MINUTE);
    if (*side == negative) {
        *value = -*value;
    }
    return true;
}

/// `hhmmss.ss` as 0.01 s of the day.
static bool time_of_day(const char* field, int32_t* value) {
    enum { MINUTE = 10000, HOUR = 100 * MINUTE };
    if (!fixed_point(field, 2, value)) {
        return false;
    }
    *value = (*value / HOUR * 60 + *value % HOUR / MINUTE) * 6000 + *value % MINUTE;
    return true;
}

bool gga_of(const Parser* parser, int32_t* values) {
    const char* address = parser->text;
    if (address[0] == 0 || address[1] == 0 || address[2] != 'G' || address[3] != 'G' || address[4] != 'A' ||
        address[5] != ',') {
        return false;
    }
    return time_of_day(sentence_field(parser, 1), &values[0]) &&
           minutes_of(sentence_field(parser, 2), sentence_field(parser, 3), 'S', &values[1]) &&
           minutes_of(sentence_field(parser, 4), sentence_field(parser, 5), 'W', &values[2]) &&
           fixed_point(sentence_field(parser, 6), 0, &values[3]) &&
           fixed_point(sentence_field(parser, 7), 0, &values[4]) &&
           fixed_point(sentence_field(parser, 9), 3, &values[5]);
}

static Setting keys_begin(void) {
    Setting setting = {.message = CFG_VALSET};
    put_u4(&setting, 0x0100);  // version 0, layer RAM
    return setting;
}

Setting speed_setting(uint32_t baud, bool by_keys) {
    if (by_keys) {
        Setting setting = keys_begin();
        put_u4(&setting, 0x40520001);  // CFG-UART1-BAUDRATE
        put_u4(&setting, baud);
        return setting;
    }
    Setting setting = {.message = CFG_PRT};
    put_u4(&setting, 1);       // UART1, no TX-ready pin
    put_u4(&setting, 0x08D0);  // 8N1
    put_u4(&setting, baud);
    put_u2(&setting, 3);  // in: UBX and NMEA
    put_u2(&setting, 3);  // out: the same
    put_u4(&setting, 0);
    return setting;
}

typedef struct {
    uint16_t message;
    uint32_t key;  // CFG-MSGOUT-…-UART1
    uint8_t rate;
} MessageRate;

static const MessageRate rates[] = {
    {0xF001, 0x209100CA, 0},   // GLL
    {0xF002, 0x209100C0, 0},   // GSA
    {0xF003, 0x209100C5, 0},   // GSV
    {0xF004, 0x209100AC, 0},   // RMC
    {0xF005, 0x209100B1, 0},   // VTG
    {0xF000, 0x209100BB, 1},   // GGA
    {NAV_PVT, 0x20910007, 1},  // NAV-PVT
};

enum { MESSAGES = sizeof rates / sizeof *rates };

unsigned setting_count(bool by_keys) { return by_keys ? 2 : MESSAGES + 1; }

static Setting keys_number(unsigned number, uint16_t period_ms) {
    Setting setting = keys_begin();
    if (number == 0) {
        for (unsigned i = 0; i < MESSAGES; ++i) {
            put_u4(&setting, rates[i].key);
            put_u1(&setting, rates[i].rate);
        }
        return setting;
    }
    put_u4(&setting, 0x30210001);  // CFG-RATE-MEAS
    put_u2(&setting, period_ms);
    return setting;
}

Setting setting_number(unsigned number, uint16_t period_ms, bool by_keys) {
    if (by_keys) {
        return keys_number(number, period_ms);
    }
    if (number < MESSAGES) {
        Setting setting = {.message = CFG_MSG};
        put_u1(&setting, (uint8_t)(rates[number].message >> 8));
        put_u1(&setting, (uint8_t)rates[number].message);
        put_u1(&setting, rates[number].rate);
        return setting;
    }
    Setting setting = {.message = CFG_RATE};
    put_u2(&setting, period_ms);
    put_u2(&setting, 1);
    put_u2(&setting, 1);  // GPS time
    return setting;
}
