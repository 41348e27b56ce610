// SPDX-License-Identifier: Apache-2.0
// Program flash and data EEPROM as the firmware writes them, with the times
// of the data sheet, and what is left when power fails in the middle.

#ifndef VIRTUAL_LATHE_NONVOLATILE_HH
#define VIRTUAL_LATHE_NONVOLATILE_HH

#include "chip.hh"

namespace lathe
{

class Nonvolatile
{
public:
    void attach();
    uint8_t flash(unsigned address) const;
    void set_flash(unsigned address, uint8_t byte);
    // A TBLWT instruction has put a byte into the holding latches.
    void latch(unsigned address, uint8_t byte);

    uint8_t eeprom[EEPROM_BYTES] = {};
    uint32_t eeprom_writes = 0;  // bytes written since the start
    uint32_t flash_erases = 0;   // blocks of 64 bytes
    uint32_t flash_writes = 0;   // blocks of 32 bytes
    uint32_t broken_unlocks = 0; // WR set without a proper 55, AA before
    uint16_t config6 = 0xFFFF;   // which blocks may be written

    uint8_t control() const
    {
        return control_;
    }
    void set_control(uint8_t value);
    void unlock(uint8_t value);

private:
    bool writable() const;
    void start();
    void finish();
    void power_lost();

    uint8_t control_ = 0;
    uint8_t latches_[32] = {};
    int unlocked_ = 0;
    uint64_t unlock_at_ = 0;
    uint64_t busy_until_ = 0;
    uint64_t began_ = 0;
    unsigned target_ = 0;
    uint8_t data_ = 0;
};

Nonvolatile &nonvolatile();

} // namespace lathe

#endif
