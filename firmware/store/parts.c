/* Part store in program flash.
   SPDX-License-Identifier: Apache-2.0 */

#include "store/parts.h"
#include "link/crc.h"      /* crc16_update */
#include "link/protocol.h" /* PART_SLOTS, errors */
#include "store/eeprom.h"  /* selected part */
#include "store/image.h"   /* the open one */
#include "store/flash.h"   /* read, erase, write */

#define IMAGE_AT FLASH_BLOCK
#define MAGIC 0x4E54u

/* Header fields, offsets in the slot. */
#define MAGIC_AT 0
#define GENERATION_AT 2
#define LENGTH_AT 4
#define CRC_AT 6
#define HEADER_CRC_AT 8

uint16_t parts_generation;
uint16_t parts_length;
uint16_t parts_crc;
uint8_t parts_upload_slot;
uint16_t parts_upload_length;

uint8_t parts_name[NAME_LENGTH];

static uint16_t newest_generation;
static uint16_t upload_crc;
static uint16_t upload_received;
static uint8_t uploading;

static uint16_t slot_base(uint8_t slot)
{
    return FLASH_STORE_BEGIN + PART_UNIT * (uint16_t)slot;
}

/* CRC of a stretch of flash. */
static uint16_t flash_crc(uint16_t address, uint16_t length)
{
    uint16_t crc = CRC16_INITIAL;

    flash_address = address;
    while (length != 0) {
        crc = crc16_update(crc, flash_read());
        length--;
    }
    return crc;
}

/* Units of a part with so many bytes of image. */
static uint8_t units(uint16_t length)
{
    return (uint8_t)((length + (IMAGE_AT + PART_UNIT - 1)) / PART_UNIT);
}

/* Reads the header of a slot; true when it is whole. */
uint8_t parts_present(uint8_t slot)
{
    uint16_t base = slot_base(slot);

    if (slot >= PART_SLOTS) {
        return 0;
    }
    flash_address = base;
    if (flash_read_u16() != MAGIC) {
        return 0;
    }
    parts_generation = flash_read_u16();
    parts_length = flash_read_u16();
    parts_crc = flash_read_u16();
    return flash_read_u16() == flash_crc(base, HEADER_CRC_AT);
}

uint8_t parts_intact(uint8_t slot)
{
    return parts_present(slot) &&
           flash_crc(slot_base(slot) + IMAGE_AT, parts_length) == parts_crc;
}

static void erase_header(uint8_t slot)
{
    flash_address = slot_base(slot);
    flash_erase_block();
}

uint8_t parts_delete(uint8_t slot)
{
    if (!parts_present(slot)) {
        return ERROR_NO_PART;
    }
    erase_header(slot);
    return ERROR_OK;
}

/* Newest present part, or SLOT_NONE; newest_generation is its generation, 0
   when there is none. */
static uint8_t newest_part(void)
{
    uint8_t best = SLOT_NONE;
    uint8_t slot;

    newest_generation = 0;
    for (slot = 0; slot < PART_SLOTS; slot++) {
        if (parts_present(slot) &&
            (best == SLOT_NONE ||
             (int16_t)(parts_generation - newest_generation) > 0)) {
            best = slot;
            newest_generation = parts_generation;
        }
    }
    return best;
}

uint8_t parts_selected(void)
{
    uint8_t slot = eeprom_read(EEPROM_SELECTED);

    return parts_present(slot) ? slot : newest_part();
}

uint8_t parts_select(uint8_t slot)
{
    if (!parts_present(slot)) {
        return ERROR_NO_PART;
    }
    eeprom_write(EEPROM_SELECTED, slot);
    return ERROR_OK;
}

uint8_t parts_select_next(void)
{
    uint8_t selected = parts_selected();
    uint8_t number = 0;
    uint8_t slot;

    if (selected == SLOT_NONE) {
        return 0;
    }
    for (slot = 0; slot < PART_SLOTS; slot++) {
        if (parts_present(slot)) {
            number++;
            if (slot > selected) {
                parts_select(slot);
                return number;
            }
        }
    }
    for (slot = 0; !parts_present(slot); slot++) {
    }
    parts_select(slot);
    return 1;
}

/* Reads the name of the image in a slot into parts_name. */
void parts_read_name(uint8_t slot)
{
    uint8_t i;

    flash_address = slot_base(slot) + IMAGE_AT + PART_IMAGE_NAME_AT;
    for (i = 0; i < NAME_LENGTH; i++) {
        parts_name[i] = flash_read();
    }
}

/* True when the image in a slot has the name in parts_name. */
static uint8_t has_name(uint8_t slot)
{
    uint8_t i;

    flash_address = slot_base(slot) + IMAGE_AT + PART_IMAGE_NAME_AT;
    for (i = 0; i < NAME_LENGTH; i++) {
        if (flash_read() != parts_name[i]) {
            return 0;
        }
    }
    return 1;
}

/* Another present part with the name of this slot's image, or SLOT_NONE; its
   generation is in parts_generation. */
static uint8_t namesake(uint8_t slot)
{
    uint8_t other;

    parts_read_name(slot);
    for (other = 0; other < PART_SLOTS; other++) {
        if (other != slot && parts_present(other) && has_name(other)) {
            return other;
        }
    }
    return SLOT_NONE;
}

void parts_init(void)
{
    uint8_t slot;
    uint8_t other;
    uint16_t generation;

    for (slot = 0; slot < PART_SLOTS; slot++) {
        if (parts_present(slot)) {
            generation = parts_generation;
            other = namesake(slot);
            if (other != SLOT_NONE) {
                erase_header((int16_t)(generation - parts_generation) > 0
                                 ? other
                                 : slot);
            }
        }
    }
}

/* First of enough free units in a row, SLOT_NONE if there are none. */
static uint8_t find_room(uint8_t wanted)
{
    uint8_t slot = 0;
    uint8_t found = 0;

    while (slot < PART_SLOTS) {
        if (parts_present(slot)) {
            slot += units(parts_length);
            found = 0;
        } else {
            slot++;
            found++;
            if (found == wanted) {
                return slot - found;
            }
        }
    }
    return SLOT_NONE;
}

uint8_t parts_upload_begin(uint16_t length, uint16_t crc)
{
    uploading = 0;
    if (length < PART_IMAGE_HEADER_SIZE || length > PART_IMAGE_MAX) {
        return ERROR_OUT_OF_RANGE;
    }
    parts_upload_slot = find_room(units(length));
    if (parts_upload_slot == SLOT_NONE) {
        return ERROR_STORE_FULL;
    }
    erase_header(parts_upload_slot);
    parts_upload_length = length;
    upload_crc = crc;
    upload_received = 0;
    uploading = 1;
    return ERROR_OK;
}

uint8_t parts_upload_data(uint16_t offset, __data const uint8_t *data,
                          uint8_t size)
{
    uint8_t i;

    if (!uploading) {
        return ERROR_NO_UPLOAD;
    }
    if (offset != upload_received || (offset & (FLASH_ROW - 1)) ||
        offset + size > parts_upload_length ||
        (size < FLASH_ROW && offset + size != parts_upload_length)) {
        return ERROR_BAD_OFFSET;
    }
    flash_address = slot_base(parts_upload_slot) + IMAGE_AT + offset;
    if (!(offset & (FLASH_BLOCK - 1))) {
        flash_erase_block();
    }
    for (i = 0; i < FLASH_ROW; i++) {
        flash_row[i] = i < size ? data[i] : 0xFF;
    }
    flash_write_row();
    upload_received += size;
    return ERROR_OK;
}

uint8_t parts_upload_finish(void)
{
    if (!uploading) {
        return ERROR_NO_UPLOAD;
    }
    if (upload_received != parts_upload_length) {
        return ERROR_BAD_LENGTH;
    }
    if (flash_crc(slot_base(parts_upload_slot) + IMAGE_AT,
                  parts_upload_length) != upload_crc) {
        uploading = 0;
        return ERROR_CRC_MISMATCH;
    }
    return ERROR_OK;
}

static void row_u16(uint8_t at, uint16_t value)
{
    flash_row[at] = (uint8_t)value;
    flash_row[at + 1] = (uint8_t)(value >> 8);
}

static void write_header(uint8_t slot)
{
    uint16_t crc = CRC16_INITIAL;
    uint8_t i;

    newest_part();
    for (i = 0; i < FLASH_ROW; i++) {
        flash_row[i] = 0xFF;
    }
    row_u16(MAGIC_AT, MAGIC);
    row_u16(GENERATION_AT, newest_generation + 1);
    row_u16(LENGTH_AT, parts_upload_length);
    row_u16(CRC_AT, upload_crc);
    for (i = 0; i < HEADER_CRC_AT; i++) {
        crc = crc16_update(crc, flash_row[i]);
    }
    row_u16(HEADER_CRC_AT, crc);
    flash_address = slot_base(slot);
    flash_write_row();
}

uint8_t parts_upload_accept(void)
{
    uint8_t slot = parts_upload_slot;
    uint8_t older = namesake(slot);

    uploading = 0;
    write_header(slot);
    if (!parts_intact(slot)) {
        erase_header(slot);
        return ERROR_FLASH_FAILED;
    }
    if (older != SLOT_NONE) {
        erase_header(older);
    }
    eeprom_write(EEPROM_SELECTED, slot);
    return ERROR_OK;
}

void parts_open(uint8_t slot)
{
    image_begin = slot_base(slot) + IMAGE_AT;
}
