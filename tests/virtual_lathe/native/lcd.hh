// SPDX-License-Identifier: Apache-2.0
// The display: an HD44780 with 16 characters on each of two lines, wired for
// 4 bits and writing only.  Two halves as on the chip: what arrives on its
// pins and when (lcd_bus.cc), and what instructions do (lcd.cc).

#ifndef VIRTUAL_LATHE_LCD_HH
#define VIRTUAL_LATHE_LCD_HH

#include "mistakes.hh"
#include "pins.hh"

namespace lathe
{

// Instructions and memories.
class LcdController
{
public:
    // Power comes: RAM holds anything, the display is off.
    void power_on();
    // The wake-up sequence has begun: nothing is taken as set up any more.
    void forget_setup();
    // One byte; returns how long it takes, in us at 270 kHz.
    double execute(bool data, unsigned byte, Mistakes &mistakes);
    bool eight_bits() const
    {
        return eight_bits_;
    }
    vl_lcd_state state = {};

private:
    double instruction(unsigned byte, Mistakes &mistakes);
    void write_data(unsigned byte, Mistakes &mistakes);
    void step_address(bool forward);
    void shift(bool left);
    void clear();
    void entry_mode(unsigned byte);
    void display_control(unsigned byte, Mistakes &mistakes);
    void cursor_or_shift(unsigned byte);
    void function_set(unsigned byte, Mistakes &mistakes);
    void set_address(unsigned byte, Mistakes &mistakes);

    bool eight_bits_ = true;
    bool increment_ = true, shifts_ = false; // entry mode
    bool function_known_ = false, cleared_ = false, entry_known_ = false;
    unsigned cgram_address_ = 0;
};

// Pins and their timing.
class LcdBus
{
public:
    // Frequency of the display's own clock: 190 to 350 kHz, typically 270.
    void attach(double oscillator_khz);
    LcdController controller;
    std::vector<vl_lcd_byte> bytes;
    Mistakes mistakes;

private:
    void chip_reset(RESET_TYPE type);
    void changed(uint64_t cycle, uint64_t levels, uint64_t changed);
    void enable_rises(uint64_t cycle);
    void enable_falls(uint64_t cycle, uint64_t levels);
    void strobe(uint64_t cycle, bool data, unsigned nibble);
    void wake(bool data, unsigned nibble);
    double execute(uint64_t cycle, bool data, unsigned byte, Mistakes &found);
    void wait(uint64_t cycle, double us, const char *what);

    double slowness_ = 1; // 270 kHz by the display's frequency
    uint64_t rs_changed_ = 0, data_changed_ = 0;
    uint64_t rise_ = 0;
    bool high_ = false; // E, as seen last
    uint64_t reset_at_ = NEVER;
    uint64_t busy_until_ = 0;
    const char *busy_with_ = "";
    int woken_ = 0; // steps of the wake-up sequence done
    bool half_ = false;
    unsigned first_half_ = 0;
};

LcdBus &lcd();

} // namespace lathe

#endif
