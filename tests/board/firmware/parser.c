#include "parser.h"

enum { IDLE, SYNC_2, CLASS, ID, LENGTH_1, LENGTH_2, PAYLOAD, SUM_A, SUM_B, TEXT, TOLD_1, TOLD_2 };

static Found give_up(Parser* parser, Found found) {
    parser->state = IDLE;
    return found;
}

/// The 8-bit Fletcher sum of class, id, length and payload.
static void add_to_sum(Parser* parser, uint8_t byte) {
    parser->sum_a = (uint8_t)(parser->sum_a + byte);
    parser->sum_b = (uint8_t)(parser->sum_b + parser->sum_a);
}

static Found begin(Parser* parser, uint8_t byte) {
    parser->state = byte == 0xB5 ? SYNC_2 : byte == '$' ? TEXT : IDLE;
    parser->sum_a = parser->sum_b = 0;
    parser->at = 0;
    parser->text_length = parser->text_sum = parser->told_sum = 0;
    return NOTHING;
}

static Found take_length(Parser* parser, uint8_t byte) {
    add_to_sum(parser, byte);
    if (parser->state == LENGTH_1) {
        parser->length = byte;
        parser->state = LENGTH_2;
        return NOTHING;
    }
    parser->length = (uint16_t)(parser->length | byte << 8);
    if (parser->length > PAYLOAD_BYTES) {
        return give_up(parser, BAD_FRAME);
    }
    parser->state = parser->length ? PAYLOAD : SUM_A;
    return NOTHING;
}

static Found take_payload(Parser* parser, uint8_t byte) {
    add_to_sum(parser, byte);
    parser->payload[parser->at++] = byte;
    if (parser->at == parser->length) {
        parser->state = SUM_A;
    }
    return NOTHING;
}

static Found take_text(Parser* parser, uint8_t byte) {
    if (byte == '*') {
        parser->text[parser->text_length] = 0;
        parser->state = TOLD_1;
        return NOTHING;
    }
    if (byte < 0x20 || byte > 0x7E || parser->text_length == SENTENCE_BYTES - 1) {
        return give_up(parser, BAD_SENTENCE);
    }
    parser->text_sum ^= byte;
    parser->text[parser->text_length++] = (char)byte;
    return NOTHING;
}

/// Upper-case hexadecimal alone, as strict clients have it.
static Found take_told_sum(Parser* parser, uint8_t byte) {
    const int digit = byte >= '0' && byte <= '9' ? byte - '0' : byte >= 'A' && byte <= 'F' ? byte - 'A' + 10 : -1;
    if (digit < 0) {
        return give_up(parser, BAD_SENTENCE);
    }
    parser->told_sum = (uint8_t)(parser->told_sum << 4 | digit);
    if (parser->state == TOLD_1) {
        parser->state = TOLD_2;
        return NOTHING;
    }
    return give_up(parser, parser->told_sum == parser->text_sum ? NMEA_SENTENCE : BAD_SENTENCE);
}

Found parser_take(Parser* parser, uint8_t byte) {
    switch (parser->state) {
        case SYNC_2:
            // A second first byte may be the real one.
            parser->state = byte == 0x62 ? CLASS : byte == 0xB5 ? SYNC_2 : IDLE;
            return NOTHING;
        case CLASS:
            parser->message_class = byte;
            add_to_sum(parser, byte);
            parser->state = ID;
            return NOTHING;
        case ID:
            parser->message_id = byte;
            add_to_sum(parser, byte);
            parser->state = LENGTH_1;
            return NOTHING;
        case LENGTH_1:
        case LENGTH_2:
            return take_length(parser, byte);
        case PAYLOAD:
            return take_payload(parser, byte);
        case SUM_A:
            if (byte != parser->sum_a) {
                return give_up(parser, BAD_FRAME);
            }
            parser->state = SUM_B;
            return NOTHING;
        case SUM_B:
            return give_up(parser, byte == parser->sum_b ? UBX_FRAME : BAD_FRAME);
        case TEXT:
            return take_text(parser, byte);
        case TOLD_1:
        case TOLD_2:
            return take_told_sum(parser, byte);
        default:
            return begin(parser, byte);
    }
}

unsigned ubx_frame(uint8_t* frame, uint16_t message, const uint8_t* payload, unsigned length) {
    uint8_t sum_a = 0, sum_b = 0;
    frame[0] = 0xB5;
    frame[1] = 0x62;
    frame[2] = (uint8_t)(message >> 8);
    frame[3] = (uint8_t)message;
    frame[4] = (uint8_t)length;
    frame[5] = (uint8_t)(length >> 8);
    for (unsigned i = 0; i < length; ++i) {
        frame[6 + i] = payload[i];
    }
    for (unsigned i = 2; i < 6 + length; ++i) {
        sum_a = (uint8_t)(sum_a + frame[i]);
        sum_b = (uint8_t)(sum_b + sum_a);
    }
    frame[6 + length] = sum_a;
    frame[7 + length] = sum_b;
    return length + 8;
}

const char* sentence_field(const Parser* parser, unsigned number) {
    const char* at = parser->text;
    while (number && *at) {
        if (*at++ == ',') {
            --number;
        }
    }
    return at;
}

bool fixed_point(const char* field, unsigned decimals, int32_t* value) {
    const bool negative = *field == '-';
    enum { LARGEST = INT32_MAX / 10 - 1 };
    unsigned digits = 0, behind = 0;
    bool point = false;
    int32_t sum = 0;
    for (const char* at = field + negative; (*at >= '0' && *at <= '9') || (*at == '.' && !point); ++at) {
        if (*at == '.') {
            point = true;
        } else if (!point || behind < decimals) {
            if (sum > LARGEST) {
                return false;
            }
            sum = sum * 10 + (*at - '0');
            ++digits;
            behind += point;
        }
    }
    for (; behind < decimals; ++behind) {
        if (sum > LARGEST) {
            return false;
        }
        sum *= 10;
    }
    *value = negative ? -sum : sum;
    return digits > 0;
}

uint16_t u2(const uint8_t* bytes) { return (uint16_t)(bytes[0] | bytes[1] << 8); }

int32_t i4(const uint8_t* bytes) {
    return (int32_t)(bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24);
}
