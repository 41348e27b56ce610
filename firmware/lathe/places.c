/* Places of a part, told by the marks of the path.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/places.h"

#define SHOWN 8

uint8_t places_to_go_on;

static uint8_t shown_operation[SHOWN];
static uint8_t shown_pass[SHOWN];
static uint8_t newest;

void places_begin(uint8_t from)
{
    newest = 0;
    places_to_go_on = from;
}

void places_next(uint8_t operation, uint8_t pass)
{
    uint8_t at;

    newest++;
    if (newest == places_to_go_on) {
        places_to_go_on = 0;
    }
    at = newest & (SHOWN - 1);
    shown_operation[at] = operation;
    shown_pass[at] = pass;
}

uint8_t places_mark(void)
{
    return places_to_go_on != 0 ? places_to_go_on : newest;
}

uint8_t places_operation(uint8_t mark)
{
    return shown_operation[mark & (SHOWN - 1)];
}

uint8_t places_pass(uint8_t mark)
{
    return shown_pass[mark & (SHOWN - 1)];
}
