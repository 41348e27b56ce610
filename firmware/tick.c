/* Milliseconds since reset.
   SPDX-License-Identifier: Apache-2.0 */

#include "tick.h"
#include "sfr.h" /* Timer 2 */

#define TIMER2_ON 0x16 /* T2CON: prescale 16, postscale 3, on */
#define TMR2IF_MASK 0x02

static volatile uint32_t milliseconds;

void tick_init(void)
{
    PR2 = 249;
    T2CON = TIMER2_ON;
    IPR1 &= (uint8_t)~TMR2IF_MASK;
    PIE1 |= TMR2IF_MASK;
}

void tick_count(void)
{
    milliseconds++;
}

uint32_t tick_uptime_ms(void)
{
    uint32_t first;
    uint32_t second = milliseconds;

    /* Equal readings were not split by the interrupt. */
    do {
        first = second;
        second = milliseconds;
    } while (first != second);
    return first;
}

uint16_t tick_now(void)
{
    return (uint16_t)tick_uptime_ms();
}

uint16_t tick_high(void)
{
    return (uint16_t)(tick_uptime_ms() >> 16);
}
