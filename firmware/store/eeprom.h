/*
 * Data EEPROM: 256 bytes.
 *
 *   0x00..0x4F  settings record, slot 0        0x50..0x9F  slot 1
 *   0xA0..0xDF  progress of a part, a ring of nine records
 *   0xE0        part that the RUN button cuts  0xF0..0xF7  serial number
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Main loop only. A write takes 4 ms; interrupts and motion go on meanwhile,
 * except for five instructions of the unlocking sequence.
 */
#ifndef EEPROM_H
#define EEPROM_H

#include <stdint.h>

#define EEPROM_SETTINGS 0x00
#define EEPROM_SETTINGS_SLOT 0x50 /* bytes of one slot */
#define EEPROM_PROGRESS 0xA0
#define EEPROM_PROGRESS_END 0xDF
#define EEPROM_SELECTED 0xE0
#define EEPROM_SERIAL 0xF0

/* Waits for a write under way. */
uint8_t eeprom_read(uint8_t address);

/* Writes one byte and waits until it is there; a byte that already has the
   value is not written, which saves time and wear. */
void eeprom_write(uint8_t address, uint8_t value);

/* The same without waiting for the end of the write; it waits for one that is
   under way, so ask eeprom_busy() first while something moves. */
void eeprom_start(uint8_t address, uint8_t value);
uint8_t eeprom_busy(void);

#endif
