/* Data EEPROM: writes that are waited for.
   SPDX-License-Identifier: Apache-2.0 */

#include "store/eeprom.h"

void eeprom_write(uint8_t address, uint8_t value)
{
    eeprom_start(address, value);
    eeprom_read(address);
}
