// SPDX-License-Identifier: Apache-2.0
// The pins of the HD44780U: bus timing of its data sheet at 5 V, a byte in two
// halves, the upper one first, and the wake-up sequence of figure 24.
//
//        ____________________________________
//   RS   ____X_______________________________
//            |40 ns|     230 ns     |10 ns
//   E              +----------------+
//        __________|                |_________
//                        | 80 ns    |10 ns
//   D4-7 ________________X__________________X_
//
// From one rise of E to the next there are 500 ns.  A cycle of the chip is
// 83 ns, so a change in the cycle of an edge breaks a rule, and in any other
// cycle none but those of E itself.  Whatever comes while the display is busy
// is lost.

#include "lcd.hh"

#include <algorithm>

namespace lathe
{

namespace
{

constexpr int DATA_PIN = A + 2; // D4 .. D7 on RA2 .. RA5
constexpr int RS_PIN = E + 0, E_PIN = E + 1;
constexpr uint64_t RS_BIT = uint64_t{1} << RS_PIN;
constexpr uint64_t E_BIT = uint64_t{1} << E_PIN;
constexpr uint64_t DATA_BITS = uint64_t{15} << DATA_PIN;
constexpr unsigned TRISA_ADDRESS = 0xF92, TRISE_ADDRESS = 0xF96;
// Pull-ups inside the display, 125 uA: on its data pins and RS, not on E.
constexpr double SUPPLY_V = 5.0, PULL_UP_OHM = 40e3;

constexpr uint64_t cycles(double ns)
{
    double exact = ns * CYCLES_PER_SECOND / 1e9;
    uint64_t whole = uint64_t(exact);
    return whole + (exact > double(whole));
}

constexpr uint64_t PULSE_CYCLES = cycles(230), PERIOD_CYCLES = cycles(500);
constexpr uint64_t ADDRESS_CYCLES = cycles(40), DATA_CYCLES = cycles(80);
constexpr size_t BYTES_MAX = 65536;
constexpr double TYPICAL_KHZ = 270;
constexpr double LONG_US = 1000; // what takes longer is clear or home

// The wake-up sequence: three times 8 bits, then 4 bits, and how long to wait
// behind each, whatever the display's clock.
constexpr int WAKE_STEPS = 4;
constexpr unsigned WAKE_NIBBLE[WAKE_STEPS] = {3, 3, 3, 2};
constexpr double POWER_US = 15000, WAKE_US[WAKE_STEPS] = {4100, 100, 37, 37};

} // namespace

LcdBus &lcd()
{
    static LcdBus instance;
    return instance;
}

void LcdBus::attach(double oscillator_khz)
{
    slowness_ = TYPICAL_KHZ / oscillator_khz;
    for (int pin = DATA_PIN; pin < DATA_PIN + 4; pin++)
        pins().drive(pin, SUPPLY_V, PULL_UP_OHM);
    pins().drive(RS_PIN, SUPPLY_V, PULL_UP_OHM);
    pins().listen([this](uint64_t cycle, uint64_t levels, uint64_t changes) {
        if (changes & (RS_BIT | E_BIT | DATA_BITS))
            changed(cycle, levels, changes);
    });
    chip().add_on_reset([this](RESET_TYPE type) { chip_reset(type); });
    high_ = pins().level(E_PIN);
    chip_reset(POR_RESET);
}

// The display has no reset pin: only a new supply resets it.  After any other
// reset of the chip it goes on, perhaps in the middle of a byte, so the chip
// must wake it up again.
void LcdBus::chip_reset(RESET_TYPE type)
{
    reset_at_ = chip().now();
    woken_ = 0;
    controller.forget_setup();
    if (type != POR_RESET)
        return;
    controller.power_on();
    half_ = false;
    busy_until_ = 0;
    wait(chip().now(), POWER_US, "power-on");
}

void LcdBus::wait(uint64_t cycle, double us, const char *what)
{
    busy_until_ = cycle + cycles(us * 1000);
    busy_with_ = what;
}

void LcdBus::changed(uint64_t cycle, uint64_t levels, uint64_t changes)
{
    // A reset of the chip lets go of all pins; that is no mistake.
    bool by_reset = cycle == reset_at_;
    if (changes & RS_BIT) {
        rs_changed_ = cycle;
        if (high_ && !by_reset)
            mistakes.add("display: RS changed while E was high");
    }
    if (changes & DATA_BITS)
        data_changed_ = cycle;
    bool high = levels & E_BIT;
    if (high == high_)
        return;
    high_ = high;
    if (high)
        enable_rises(cycle);
    else if (!by_reset)
        enable_falls(cycle, levels);
}

void LcdBus::enable_rises(uint64_t cycle)
{
    if (cycle < rs_changed_ + ADDRESS_CYCLES)
        mistakes.add("display: RS set less than 40 ns before E");
    if (rise_ && cycle < rise_ + PERIOD_CYCLES)
        mistakes.add(text("display: %.0f ns from E to E, 500 ns wanted",
                          (cycle - rise_) * 1e9 / CYCLES_PER_SECOND));
    rise_ = cycle;
}

void LcdBus::enable_falls(uint64_t cycle, uint64_t levels)
{
    if (cycle < rise_ + PULSE_CYCLES)
        mistakes.add(text("display: E high for %.0f ns, 230 ns wanted",
                          (cycle - rise_) * 1e9 / CYCLES_PER_SECOND));
    if (cycle < data_changed_ + DATA_CYCLES)
        mistakes.add("display: data set less than 80 ns before E falls");
    Register **registers = chip().cpu->registers;
    unsigned inputs = registers[TRISA_ADDRESS]->get_value() & DATA_BITS;
    if (inputs || registers[TRISE_ADDRESS]->get_value() & 1)
        mistakes.add("display: E falls while D4 to D7 or RS are not driven");
    strobe(cycle, levels & RS_BIT, (levels & DATA_BITS) >> DATA_PIN);
}

void LcdBus::strobe(uint64_t cycle, bool data, unsigned nibble)
{
    if (cycle < busy_until_) {
        mistakes.add(text("display: written %.1f us too early, busy with %s",
                          (busy_until_ - cycle) * 1e6 / CYCLES_PER_SECOND,
                          busy_with_));
        return;
    }
    int step = woken_;
    wake(data, nibble);
    // The wake-up may complete an old byte that nobody meant.
    Mistakes not_meant;
    Mistakes &found = step < WAKE_STEPS ? not_meant : mistakes;
    double us = 0;
    if (controller.eight_bits()) {
        // D0 to D3 are open, with pull-ups inside the display.
        us = execute(cycle, data, nibble << 4 | 15, found);
        half_ = false;
    } else if (half_) {
        us = execute(cycle, data, first_half_ << 4 | nibble, found);
        half_ = false;
    } else {
        first_half_ = nibble;
        half_ = true;
    }
    us *= slowness_;
    if (step < WAKE_STEPS && us < WAKE_US[step])
        wait(cycle, WAKE_US[step], "the wake-up sequence");
    else
        wait(cycle, us, us > LONG_US ? "clear or home" : "the last byte");
}

double LcdBus::execute(uint64_t cycle, bool data, unsigned byte,
                       Mistakes &found)
{
    if (bytes.size() < BYTES_MAX)
        bytes.push_back({cycle, data, uint8_t(byte)});
    return controller.execute(data, byte, found);
}

// Counts the steps of the wake-up sequence, whether the display still waits
// for the second half of an old byte or not.
void LcdBus::wake(bool data, unsigned nibble)
{
    // Into the same wake-up again, without a reset of the chip.
    if (woken_ == WAKE_STEPS && controller.eight_bits())
        woken_ = WAKE_STEPS - 1;
    if (woken_ == WAKE_STEPS)
        return;
    bool again = woken_ == WAKE_STEPS - 1 && nibble == WAKE_NIBBLE[0];
    if (data || (nibble != WAKE_NIBBLE[woken_] && !again))
        mistakes.add(text("display: %X%s in step %d of the wake-up sequence, "
                          "%X wanted",
                          nibble, data ? " as data" : "", woken_ + 1,
                          WAKE_NIBBLE[woken_]));
    if (!again)
        woken_++;
}

} // namespace lathe

int vl_lcd_bytes(struct vl_lcd_byte *entries, int room)
{
    return lathe::take(lathe::lcd().bytes, entries, room);
}
