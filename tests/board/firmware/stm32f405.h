/// The registers of an STM32F405 that this program uses, by their addresses.
/// Sources: RM0090 (memory map, table 1; RCC 7.3; GPIO 8.4; USART 30.6; FLASH 3.9) and PM0214 (SysTick 4.5, NVIC 4.3).
#ifndef STM32F405_H
#define STM32F405_H

#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t*)(address))

#define RCC_CR REGISTER(0x40023800u)
#define RCC_PLLCFGR REGISTER(0x40023804u)
#define RCC_CFGR REGISTER(0x40023808u)
#define RCC_AHB1ENR REGISTER(0x40023830u)
#define RCC_APB1ENR REGISTER(0x40023840u)
#define RCC_APB2ENR REGISTER(0x40023844u)
#define FLASH_ACR REGISTER(0x40023C00u)

#define GPIOA_MODER REGISTER(0x40020000u)
#define GPIOA_AFRL REGISTER(0x40020020u)
#define GPIOA_AFRH REGISTER(0x40020024u)

#define SYSTICK_CSR REGISTER(0xE000E010u)
#define SYSTICK_RVR REGISTER(0xE000E014u)
#define SYSTICK_CVR REGISTER(0xE000E018u)
#define NVIC_ISER1 REGISTER(0xE000E104u)

/// One USART. Offsets: RM0090, 30.6.8.
typedef struct {
    volatile uint32_t sr, dr, brr, cr1, cr2, cr3;
} Usart;

#define USART1 ((Usart*)0x40011000u)
#define USART2 ((Usart*)0x40004400u)

enum {
    USART_SR_ORE = 1u << 3,
    USART_SR_RXNE = 1u << 5,
    USART_SR_TC = 1u << 6,
    USART_SR_TXE = 1u << 7,
    USART_CR1_RE = 1u << 2,
    USART_CR1_TE = 1u << 3,
    USART_CR1_RXNEIE = 1u << 5,
    USART_CR1_UE = 1u << 13,
    USART1_IRQ = 37,
    USART2_IRQ = 38,
};

/// Hz, as clocks_begin() sets them.
enum { CORE_HZ = 168000000, APB1_HZ = 42000000, APB2_HZ = 84000000 };

#endif
