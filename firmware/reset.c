/* Cause of the last reset.
   SPDX-License-Identifier: Apache-2.0 */

#include "reset.h"
#include "link/protocol.h" /* causes */

/* RCON: a bit that is 0 tells what happened. */
#define RCON_BOR 0x01
#define RCON_POR 0x02
#define RCON_TO 0x08
#define RCON_RI 0x10
#define STKPTR_FAULTS 0xC0

volatile uint8_t reset_rcon;
volatile uint8_t reset_stkptr;

uint8_t reset_cause(void)
{
    if (!(reset_rcon & RCON_POR)) {
        return RESET_CAUSE_POWER_ON;
    }
    if (!(reset_rcon & RCON_BOR)) {
        return RESET_CAUSE_BROWN_OUT;
    }
    if (!(reset_rcon & RCON_TO)) {
        return RESET_CAUSE_WATCHDOG;
    }
    if (!(reset_rcon & RCON_RI)) {
        return RESET_CAUSE_SOFTWARE;
    }
    if (reset_stkptr & STKPTR_FAULTS) {
        return RESET_CAUSE_STACK;
    }
    return RESET_CAUSE_MCLR;
}
