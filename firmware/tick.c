/* Milliseconds since reset.
   SPDX-License-Identifier: Apache-2.0 */

#include "tick.h"
#include "sfr.h" /* Timer 2 */

#define TIMER2_ON 0x16 /* T2CON: prescale 16, postscale 3, on */
#define TMR2IF_MASK 0x02

static volatile uint16_t milliseconds;
volatile uint16_t tick_high; /* of the 32 bits */

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
    if (milliseconds == 0) {
        tick_high++;
    }
}

uint16_t tick_now(void)
{
    uint16_t first;
    uint16_t second = milliseconds;

    /* Equal readings were not split by the interrupt. */
    do {
        first = second;
        second = milliseconds;
    } while (first != second);
    return first;
}
