/// Finds UBX frames and NMEA sentences in a stream, and holds their checksums.
#ifndef PARSER_H
#define PARSER_H

#include <stdbool.h>
#include <stdint.h>

enum { PAYLOAD_BYTES = 512, SENTENCE_BYTES = 120 };

typedef enum { NOTHING, UBX_FRAME, NMEA_SENTENCE, BAD_FRAME, BAD_SENTENCE } Found;

/// `State:` what has been heard of the frame or sentence under way. After UBX_FRAME the class, id and payload, after
/// NMEA_SENTENCE the text between `$` and `*` (ended by a zero) stand there until the next byte.
typedef struct {
    uint8_t state;
    uint8_t sum_a, sum_b;
    uint8_t message_class, message_id;
    uint16_t length, at;
    uint8_t payload[PAYLOAD_BYTES];
    char text[SENTENCE_BYTES];
    uint8_t text_length, text_sum, told_sum;
} Parser;

/// Takes one byte, and tells what ended with it.
Found parser_take(Parser* parser, uint8_t byte);

/// The frame that goes out: sync, class, id, length, payload, checksum; `frame` has room for 8 bytes more than the
/// payload. Gives its length. Layout: u-blox 8 / M8 Receiver Description (UBX-13003221), 32.2.
unsigned ubx_frame(uint8_t* frame, uint16_t message, const uint8_t* payload, unsigned length);

/// A field of a sentence, counted from its address 0, up to the comma; an empty one where there is none.
const char* sentence_field(const Parser* parser, unsigned number);

/// A decimal number as a whole one of so many decimals: `4723.91234` with 5 is 472391234. Digits beyond are cut off.
/// Gives false where there is no number.
bool fixed_point(const char* field, unsigned decimals, int32_t* value);

/// Little-endian integers of a payload.
uint16_t u2(const uint8_t* bytes);
int32_t i4(const uint8_t* bytes);

#endif
