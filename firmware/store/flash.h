/*
 * Program flash: read a byte, erase 64, write 32.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Erasing and writing stop the processor for about 2 ms each (data sheet
 * D133A), interrupts included: never while moving. The caller sees to it
 * that addresses lie in the part store (0x7600..0x7FFF); others are ignored.
 */
#ifndef FLASH_H
#define FLASH_H

#include <stdint.h>

#define FLASH_BLOCK 64u /* erased together */
#define FLASH_ROW 32u   /* written together */
#define FLASH_STORE_BEGIN 0x7600u
#define FLASH_STORE_END 0x8000u

/* Address for the next call; flash_read() advances it by one. */
extern volatile uint16_t flash_address;

/* Source of flash_write_row(): 32 bytes. */
extern volatile uint8_t flash_row[FLASH_ROW];

/* Return the number at flash_address, little endian, and step on: 15 to 40
   cycles with the call. */
uint8_t flash_read(void);
uint16_t flash_read_u16(void);
int32_t flash_read_i24(void);
uint32_t flash_read_u32(void);

/* Erases the 64 bytes that flash_address lies in. */
void flash_erase_block(void);

/* Writes flash_row to the 32 bytes at flash_address (a multiple of 32),
   which must be erased. */
void flash_write_row(void);

#endif
