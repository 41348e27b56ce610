/* The lamp of the status LED.
   SPDX-License-Identifier: Apache-2.0 */

#include "board.h"     /* LED_STATUS_MASK */
#include "panel/led.h" /* when */
#include "sfr.h"       /* LATC */

void led_on(void)
{
    LATC |= LED_STATUS_MASK;
}

void led_off(void)
{
    LATC &= (uint8_t)~LED_STATUS_MASK;
}
