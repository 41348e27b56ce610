/* Data EEPROM, byte by byte.
   SPDX-License-Identifier: Apache-2.0 */

#include "store/eeprom.h"
#include "sfr.h" /* EECON1 */

#define EECON1_RD 0x01
#define EECON1_WR 0x02
#define EECON1_WREN 0x04

uint8_t eeprom_read(uint8_t address)
{
    EEADR = address;
    EECON1 = EECON1_RD;
    return EEDATA;
}

void eeprom_write(uint8_t address, uint8_t value)
{
    uint8_t interrupts = INTCON & 0xC0;

    if (eeprom_read(address) == value) {
        return;
    }
    EEADR = address;
    EEDATA = value;
    EECON1 = EECON1_WREN;
    INTCON &= 0x3F;
    EECON2 = 0x55;
    EECON2 = 0xAA;
    EECON1 |= EECON1_WR;
    INTCON |= interrupts;
    while (EECON1 & EECON1_WR) {
        __asm__("clrwdt");
    }
    EECON1 = 0;
}
