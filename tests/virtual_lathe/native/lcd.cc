// SPDX-License-Identifier: Apache-2.0
// Instructions of the HD44780U (table 6 of its data sheet) and its memories.
// After an initialisation by instruction nothing is known but the interface:
// the function is set first, then the display is cleared and the entry mode
// set before it is switched on (figure 24).

#include "lcd.hh"

#include <algorithm>
#include <cstring>

namespace lathe
{

namespace
{

constexpr int LINE = 40, CELLS = 80;       // characters of DDRAM
constexpr unsigned SECOND_LINE = 0x40;     // address of its first character
constexpr unsigned FUNCTION_8_BITS = 0x10; // bits of the function set
constexpr unsigned FUNCTION_2_LINES = 0x08, FUNCTION_5X10 = 0x04;
// Execution times in us at 270 kHz.  The address counter follows a write of
// data 4 us after the busy flag (figure 10).
constexpr double SHORT_US = 37, LONG_US = 1520, DATA_US = 37 + 4;

} // namespace

void LcdController::power_on()
{
    state = {};
    for (int i = 0; i < CELLS; i++)
        state.ddram[i] = 0xA1 + i % 0x3F;
    memset(state.cgram, 0x15, sizeof state.cgram);
    eight_bits_ = true;
    increment_ = true;
    shifts_ = false;
    forget_setup();
}

void LcdController::forget_setup()
{
    function_known_ = cleared_ = entry_known_ = false;
}

double LcdController::execute(bool data, unsigned byte, Mistakes &mistakes)
{
    bool function = !data && (byte & 0xE0) == 0x20;
    if (!eight_bits_ && !function_known_ && !function)
        mistakes.add("display: written before the function was set");
    state.writes++;
    if (!data)
        return instruction(byte, mistakes);
    write_data(byte, mistakes);
    return DATA_US;
}

// The highest bit that is set says which instruction it is.
double LcdController::instruction(unsigned byte, Mistakes &mistakes)
{
    if (byte & 0xC0)
        set_address(byte, mistakes);
    else if (byte & 0x20)
        function_set(byte, mistakes);
    else if (byte & 0x10)
        cursor_or_shift(byte);
    else if (byte & 0x08)
        display_control(byte, mistakes);
    else if (byte & 0x04)
        entry_mode(byte);
    else if (byte & 0x03) {
        if (byte == 0x01)
            clear();
        state.address = 0;
        state.shift = 0;
        state.in_cgram = 0;
        return LONG_US;
    } else
        mistakes.add("display: 0x00 is no instruction");
    return SHORT_US;
}

void LcdController::clear()
{
    memset(state.ddram, ' ', sizeof state.ddram);
    increment_ = true;
    cleared_ = true;
}

void LcdController::entry_mode(unsigned byte)
{
    increment_ = byte & 0x02;
    shifts_ = byte & 0x01;
    entry_known_ = true;
}

void LcdController::display_control(unsigned byte, Mistakes &mistakes)
{
    state.on = byte >> 2 & 1;
    state.cursor = byte >> 1 & 1;
    state.blink = byte & 1;
    if (state.on && !cleared_)
        mistakes.add("display: switched on before it was cleared");
}

void LcdController::cursor_or_shift(unsigned byte)
{
    bool right = byte & 0x04;
    if (byte & 0x08)
        shift(!right);
    else
        step_address(right);
}

void LcdController::function_set(unsigned byte, Mistakes &mistakes)
{
    bool eight = byte & FUNCTION_8_BITS;
    bool two = byte & FUNCTION_2_LINES;
    if (eight_bits_ || eight) {
        // Between the two interfaces D0 to D3 are open: only DL counts.
        eight_bits_ = eight;
        function_known_ = false;
        return;
    }
    if (!two || byte & FUNCTION_5X10)
        mistakes.add(text("display: function set 0x%02x is not for two lines "
                          "of 5x8 dots",
                          byte));
    if (function_known_ && two != state.two_lines)
        mistakes.add("display: lines changed without a wake-up sequence");
    state.two_lines = two;
    function_known_ = true;
}

void LcdController::set_address(unsigned byte, Mistakes &mistakes)
{
    state.in_cgram = !(byte & 0x80);
    if (state.in_cgram) {
        cgram_address_ = byte & 0x3F;
        return;
    }
    unsigned address = byte & 0x7F;
    unsigned column = address & (SECOND_LINE - 1);
    if (column >= LINE) {
        mistakes.add(text("display: DDRAM has no address 0x%02x", address));
        return;
    }
    state.address = (address & SECOND_LINE ? LINE : 0) + column;
}

void LcdController::write_data(unsigned byte, Mistakes &mistakes)
{
    if (!entry_known_)
        mistakes.add("display: data before the entry mode was set");
    if (state.in_cgram)
        state.cgram[cgram_address_] = byte & 0x1F;
    else
        state.ddram[state.address] = byte;
    if (shifts_ && !state.in_cgram)
        shift(increment_);
    step_address(increment_);
}

// From the end of one line to the begin of the other, as the address counter
// goes with two lines.
void LcdController::step_address(bool forward)
{
    int step = forward ? 1 : -1;
    if (state.in_cgram)
        cgram_address_ = (cgram_address_ + step) & 0x3F;
    else
        state.address = (state.address + step + CELLS) % CELLS;
}

void LcdController::shift(bool left)
{
    state.shift = (state.shift + (left ? 1 : LINE - 1)) % LINE;
}

} // namespace lathe

using lathe::lcd;

void vl_lcd_attach(double oscillator_khz)
{
    lcd().attach(oscillator_khz);
}

void vl_lcd_read(struct vl_lcd_state *state)
{
    *state = lcd().controller.state;
}

int vl_lcd_mistake(unsigned index, char *text, unsigned room)
{
    return lcd().mistakes.copy(index, text, room);
}
