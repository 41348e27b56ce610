/*
 * Settings: 16-bit numbers by id (link/protocol.toml has names, units and
 * ranges), kept in EEPROM so that a cut of power at any moment leaves the
 * old ones or the new ones.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Two slots. A record is: format, sequence, values, CRC-16. Saving writes
 * the older slot, its CRC last; loading takes the valid record with the
 * newer sequence. Main loop only.
 */
#ifndef SETTINGS_H
#define SETTINGS_H

#include <stdint.h>
#include "link/protocol.h" /* SETTING_COUNT, ids */

extern int16_t settings[SETTING_COUNT];

/* Loads the newest valid record. Returns 1 when one was found or the EEPROM
   is blank (then the defaults hold), 0 when both records are damaged: the
   defaults hold and the user must be told. */
uint8_t settings_load(void);

/* Changes one setting and stores all: up to 90 EEPROM writes of 4 ms, some
   ten as a rule. Returns ERROR_OK or ERROR_OUT_OF_RANGE. */
uint8_t settings_set(uint8_t id, int16_t value);

/* Stores the settings as they are in RAM. */
void settings_save(void);

/* Range of a setting with id < SETTING_COUNT. */
int16_t settings_minimum(uint8_t id);
int16_t settings_maximum(uint8_t id);

#endif
