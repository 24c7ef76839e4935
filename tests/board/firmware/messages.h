/// What the driver sends and what it reads out of messages. Layouts: u-blox 8 / M8 Receiver Description (UBX-13003221)
/// and F9 HPG 1.32 Interface Description (UBX-22008968); sentences: NMEA 0183, 4.10.
#ifndef MESSAGES_H
#define MESSAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "parser.h"

enum {
    NAV_PVT = 0x0107,
    ACK_NAK = 0x0500,
    ACK_ACK = 0x0501,
    CFG_PRT = 0x0600,
    CFG_MSG = 0x0601,
    CFG_RATE = 0x0608,
    CFG_VALSET = 0x068A,
    MON_VER = 0x0A04,
    SOLUTION_VALUES = 13,
    GGA_VALUES = 6,
    SETTING_BYTES = 48,
};

/// Values in the order and units of the report `pvt` (driver.h).
typedef struct {
    int32_t values[SOLUTION_VALUES];
    bool good;  // gnssFixOK, and a fix of two or three dimensions
} Solution;

typedef struct {
    uint16_t message;
    uint8_t payload[SETTING_BYTES];
    unsigned length;
} Setting;

Solution solution_of(const uint8_t* nav_pvt);

/// The protocol version of MON-VER times 100, 0 when it is not told.
int32_t protocol_of(const uint8_t* mon_ver, unsigned length);

/// Values in the order and units of the report `gga`; false when it is another sentence, or one without a position.
bool gga_of(const Parser* parser, int32_t* values);

/// The speed of UART1, by CFG-PRT or by its key.
Setting speed_setting(uint32_t baud, bool by_keys);

/// The other settings one after the other: messages on and off, then the rate.
unsigned setting_count(bool by_keys);
Setting setting_number(unsigned number, uint16_t period_ms, bool by_keys);

#endif
