/// What runs before main(): the vector table, the memory's first contents, the clocks.
#include "board.h"
#include "stm32f405.h"

extern uint32_t stack_top, data_begin, data_end, data_image, bss_begin, bss_end;

int main(void);
void reset_handler(void);

/// The compiler calls these two by name, with no library there either.
void* memcpy(void* to, const void* from, unsigned count);
void* memset(void* to, int value, unsigned count);

void* memcpy(void* to, const void* from, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
        ((uint8_t*)to)[i] = ((const uint8_t*)from)[i];
    }
    return to;
}

void* memset(void* to, int value, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
        ((uint8_t*)to)[i] = (uint8_t)value;
    }
    return to;
}

/// Waits for a bit, but not for ever: QEMU's machine has no clock control, and runs at 168 MHz whatever is written.
static void wait_for_bit(volatile uint32_t* word, uint32_t bit) {
    for (unsigned i = 0; i < 10000 && (*word & bit) == 0; ++i) {
    }
}

/// 168 MHz from the internal oscillator of 16 MHz: / 16 × 336 / 2 (RM0090, 7.3.2). Five wait states (3.5.1, table 10).
/// APB1 has a fourth of it, APB2 half.
static void clocks_begin(void) {
    enum { PLL_ON = 1u << 24, PLL_READY = 1u << 25, CACHES_AND_FIVE_WAITS = 0x705u };
    FLASH_ACR = CACHES_AND_FIVE_WAITS;
    RCC_PLLCFGR = 16u | 336u << 6 | 0u << 16 | 7u << 24;
    RCC_CR |= PLL_ON;
    wait_for_bit(&RCC_CR, PLL_READY);
    RCC_CFGR = 2u | 5u << 10 | 4u << 13;
    wait_for_bit(&RCC_CFGR, 2u << 2);
}

void reset_handler(void) {
    const uint32_t* image = &data_image;
    for (uint32_t* word = &data_begin; word < &data_end; ++word) {
        *word = *image++;
    }
    for (uint32_t* word = &bss_begin; word < &bss_end; ++word) {
        *word = 0;
    }
    clocks_begin();
    board_begin();
    main();
    for (;;) {
    }
}

static void fault_handler(void) {
    report_text("fault");
    report_end();
    for (;;) {
    }
}

/// Positions: RM0090, table 61.
typedef struct {
    uint32_t* stack;
    void (*system[15])(void);
    void (*interrupt[USART2_IRQ + 1])(void);
} Vectors;

__attribute__((section(".vectors"), used)) static const Vectors vectors = {
    .stack = &stack_top,
    .system = {[0] = reset_handler,
               [1] = fault_handler,
               [2] = fault_handler,
               [3] = fault_handler,
               [4] = fault_handler,
               [5] = fault_handler,
               [14] = tick_handler},
    .interrupt = {[USART1_IRQ] = report_line_handler, [USART2_IRQ] = receiver_line_handler},
};
