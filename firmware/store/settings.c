/* Settings in two EEPROM slots.
   SPDX-License-Identifier: Apache-2.0 */

#include "store/settings.h"
#include "link/crc.h"     /* crc16_update */
#include "store/eeprom.h" /* slots */

#define FORMAT 2
#define BLANK 0xFF
#define VALUES_AT 2
#define CRC_AT (VALUES_AT + 2 * SETTING_COUNT)

#if CRC_AT + 2 > EEPROM_SETTINGS_SLOT
#error "the settings no longer fit their EEPROM slot"
#endif

#define TAKE_DEFAULT(id, name, normal, minimum, maximum) normal,
#define TAKE_MINIMUM(id, name, normal, minimum, maximum) minimum,
#define TAKE_MAXIMUM(id, name, normal, minimum, maximum) maximum,

static __code const int16_t defaults[] = {SETTINGS(TAKE_DEFAULT)};
static __code const int16_t minima[] = {SETTINGS(TAKE_MINIMUM)};
static __code const int16_t maxima[] = {SETTINGS(TAKE_MAXIMUM)};

int16_t settings[SETTING_COUNT];

static uint8_t newest;   /* address of the record in force */
static uint8_t sequence; /* its sequence number */

static uint16_t record_crc(uint8_t slot)
{
    uint16_t crc = CRC16_INITIAL;
    uint8_t i;

    for (i = 1; i < CRC_AT; i++) {
        crc = crc16_update(crc, eeprom_read(slot + i));
    }
    return crc;
}

static uint8_t record_valid(uint8_t slot)
{
    uint16_t crc = record_crc(slot);

    return eeprom_read(slot) == FORMAT &&
           eeprom_read(slot + CRC_AT) == (uint8_t)crc &&
           eeprom_read(slot + CRC_AT + 1) == (uint8_t)(crc >> 8);
}

static void record_read(uint8_t slot)
{
    __data uint8_t *to = (__data uint8_t *)settings;
    uint8_t i;

    for (i = 0; i < 2 * SETTING_COUNT; i++) {
        to[i] = eeprom_read(slot + VALUES_AT + i);
    }
    newest = slot;
    sequence = eeprom_read(slot + 1);
}

uint8_t settings_load(void)
{
    uint8_t first = record_valid(EEPROM_SETTINGS);
    uint8_t second = record_valid(EEPROM_SETTINGS_SLOT);
    uint8_t i;

    if (first && second) {
        /* Sequence numbers differ by one; the wrap from 255 to 0 counts. */
        second = (uint8_t)(eeprom_read(EEPROM_SETTINGS + 1) + 1) ==
                 eeprom_read(EEPROM_SETTINGS_SLOT + 1);
        first = !second;
    }
    if (first) {
        record_read(EEPROM_SETTINGS);
        return 1;
    }
    if (second) {
        record_read(EEPROM_SETTINGS_SLOT);
        return 1;
    }
    for (i = 0; i < SETTING_COUNT; i++) {
        settings[i] = defaults[i];
    }
    newest = EEPROM_SETTINGS_SLOT;
    return eeprom_read(EEPROM_SETTINGS) == BLANK &&
           eeprom_read(EEPROM_SETTINGS_SLOT) == BLANK;
}

void settings_save(void)
{
    __data const uint8_t *from = (__data const uint8_t *)settings;
    uint8_t slot = newest ? EEPROM_SETTINGS : EEPROM_SETTINGS_SLOT;
    uint16_t crc;
    uint8_t i;

    sequence++;
    eeprom_write(slot, BLANK); /* no record until it is complete */
    eeprom_write(slot + 1, sequence);
    for (i = 0; i < 2 * SETTING_COUNT; i++) {
        eeprom_write(slot + VALUES_AT + i, from[i]);
    }
    crc = record_crc(slot);
    eeprom_write(slot + CRC_AT, (uint8_t)crc);
    eeprom_write(slot + CRC_AT + 1, (uint8_t)(crc >> 8));
    eeprom_write(slot, FORMAT);
    newest = slot;
}

uint8_t settings_set(uint8_t id, int16_t value)
{
    if (id >= SETTING_COUNT || value < minima[id] || value > maxima[id]) {
        return ERROR_OUT_OF_RANGE;
    }
    if (settings[id] != value) {
        settings[id] = value;
        settings_save();
    }
    return ERROR_OK;
}

int16_t settings_minimum(uint8_t id)
{
    return minima[id];
}

int16_t settings_maximum(uint8_t id)
{
    return maxima[id];
}
