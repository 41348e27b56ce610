/* Data EEPROM, byte by byte.
   SPDX-License-Identifier: Apache-2.0 */

#include "store/eeprom.h"
#include "sfr.h" /* EECON1 */

#define EECON1_RD 0x01
#define EECON1_WR 0x02
#define EECON1_WREN 0x04

uint8_t eeprom_busy(void)
{
    return EECON1 & EECON1_WR;
}

uint8_t eeprom_read(uint8_t address)
{
    while (eeprom_busy()) {
        __asm__("clrwdt");
    }
    EEADR = address;
    EECON1 = EECON1_RD;
    return EEDATA;
}

void eeprom_start(uint8_t address, uint8_t value)
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
    EECON1 &= (uint8_t)~EECON1_WREN;
    INTCON |= interrupts;
}
