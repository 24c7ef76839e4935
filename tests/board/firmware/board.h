/// The board: a clock of milliseconds, the line to the receiver (USART2: PA2, PA3) and the line that reports are
/// written to (USART1: PA9, PA10, 115200 baud).
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

/// Pins, lines and clock; called once, before main().
void board_begin(void);

/// Milliseconds since board_begin().
uint32_t milliseconds(void);
/// Sleeps until the next interrupt, at most a millisecond.
void rest(void);

/// Gives the line to the receiver another speed, once all that was sent has left at the old one. Reports
/// `line SPEED BRR` with what stands in the divider, and waits a moment for whoever has to follow by hand.
void receiver_line_speed(uint32_t baud);
/// Sends bytes at the speed of the line.
void receiver_send(const uint8_t* bytes, unsigned count);
/// The next byte that was heard, or −1.
int receiver_byte(void);
/// Bytes that were heard, and those of them that were lost because nobody took them.
uint32_t receiver_bytes_heard(void);
uint32_t receiver_bytes_lost(void);

/// A report is one line: words and numbers with spaces between, then report_end().
void report_text(const char* word);
void report_number(int32_t value);
void report_end(void);

void tick_handler(void);
void report_line_handler(void);
void receiver_line_handler(void);

#endif
