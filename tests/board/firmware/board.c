#include "board.h"

#include "stm32f405.h"

enum { RING = 2048, BITS_OF_A_BYTE = 10, FOLLOW_MS = 400 };

static volatile uint32_t now_ms;
static volatile uint8_t ring[RING];
static volatile uint32_t ring_in, ring_out, lost;
static volatile bool followed;
static uint32_t line_baud, line_free_ms;
static bool line_begun;

void tick_handler(void) { now_ms = now_ms + 1; }

/// Whoever follows the line's speed by hand answers with any byte.
void report_line_handler(void) {
    (void)USART1->sr;
    (void)USART1->dr;
    followed = true;
}

void receiver_line_handler(void) {
    const uint32_t status = USART2->sr;
    const uint8_t byte = (uint8_t)USART2->dr;
    if (status & USART_SR_ORE) {
        lost = lost + 1;
    }
    if (!(status & USART_SR_RXNE)) {
        return;
    }
    if (ring_in - ring_out == RING) {
        lost = lost + 1;
        return;
    }
    ring[ring_in % RING] = byte;
    ring_in = ring_in + 1;
}

/// The divider for a speed, in sixteenths with oversampling by 16: RM0090, 30.3.4.
static uint32_t divider(uint32_t clock_hz, uint32_t baud) { return (clock_hz + baud / 2) / baud; }

void board_begin(void) {
    enum { ALTERNATE_PINS = 0xA0u | 0x280000u, PIN_MASK = 0xF0u | 0x3C0000u };
    RCC_AHB1ENR |= 1u;        // port A
    RCC_APB1ENR |= 1u << 17;  // USART2
    RCC_APB2ENR |= 1u << 4;   // USART1
    GPIOA_MODER = (GPIOA_MODER & ~(uint32_t)PIN_MASK) | ALTERNATE_PINS;
    GPIOA_AFRL = (GPIOA_AFRL & ~0xFF00u) | 0x7700u;
    GPIOA_AFRH = (GPIOA_AFRH & ~0xFF0u) | 0x770u;
    USART1->brr = divider(APB2_HZ, 115200);
    USART1->cr1 = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE;
    SYSTICK_RVR = CORE_HZ / 1000 - 1;
    SYSTICK_CVR = 0;
    SYSTICK_CSR = 7u;  // the core's clock, interrupt, on
    NVIC_ISER1 = 1u << (USART1_IRQ - 32) | 1u << (USART2_IRQ - 32);
}

uint32_t milliseconds(void) { return now_ms; }

void rest(void) { __asm__ volatile("wfi"); }

/// QEMU's USART is done with a byte at once; the clock tells when a real one is.
static void wait_until_sent(void) {
    while (line_begun && ((int32_t)(now_ms - line_free_ms) < 0 || !(USART2->sr & USART_SR_TC))) {
        rest();
    }
}

void receiver_line_speed(uint32_t baud) {
    wait_until_sent();
    USART2->cr1 = 0;
    USART2->brr = divider(APB1_HZ, baud);
    line_baud = baud;
    ring_out = ring_in;
    followed = false;
    report_text("line");
    report_number((int32_t)baud);
    report_number((int32_t)USART2->brr);
    report_end();
    const uint32_t began = now_ms;
    while (!followed && now_ms - began < FOLLOW_MS) {
        rest();
    }
    USART2->cr1 = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE;
    line_begun = true;
    line_free_ms = now_ms;
}

void receiver_send(const uint8_t* bytes, unsigned count) {
    wait_until_sent();
    for (unsigned i = 0; i < count; ++i) {
        while (!(USART2->sr & USART_SR_TXE)) {
        }
        USART2->dr = bytes[i];
    }
    // One more, as the running millisecond has begun already.
    line_free_ms = now_ms + count * BITS_OF_A_BYTE * 1000u / line_baud + 2;
}

int receiver_byte(void) {
    if (ring_out == ring_in) {
        return -1;
    }
    const int byte = ring[ring_out % RING];
    ring_out = ring_out + 1;
    return byte;
}

uint32_t receiver_bytes_heard(void) { return ring_in; }

uint32_t receiver_bytes_lost(void) { return lost; }

static void report_char(char character) {
    while (!(USART1->sr & USART_SR_TXE)) {
    }
    USART1->dr = (uint8_t)character;
}

void report_text(const char* word) {
    for (; *word; ++word) {
        report_char(*word);
    }
}

void report_number(int32_t value) {
    char digits[11];
    unsigned count = 0;
    uint32_t rest_of_it = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    do {
        digits[count++] = (char)('0' + rest_of_it % 10);
        rest_of_it /= 10;
    } while (rest_of_it);
    report_char(' ');
    if (value < 0) {
        report_char('-');
    }
    while (count) {
        report_char(digits[--count]);
    }
}

void report_end(void) { report_text("\r\n"); }
