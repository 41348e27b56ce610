// SPDX-License-Identifier: Apache-2.0
// Figures 21-3 and 21-4, equations 21-1 to 21-3 and table 28-29 of the data
// sheet.
//
//   pin --- RS --- RIC 1k --- RSS 2k (at 5 V) ---+--- converter
//                                                |
//                                               25 pF
//
// The capacitor follows the selected input from the moment it is connected
// (channel selected, converter switched on, last conversion over) until the
// conversion starts: at once when GO is set with ACQT = 0, after 2 to 20 TAD
// else.  A conversion takes 11 TAD.  Special event triggers of CCP2 are not
// modelled.

#include "adc.hh"

#include "pins.hh"

#include <algorithm>
#include <cmath>

namespace lathe
{

namespace
{

constexpr unsigned ADCON2_ADDRESS = 0xFC0, ADCON1_ADDRESS = 0xFC1;
constexpr unsigned ADCON0_ADDRESS = 0xFC2;
constexpr unsigned ADRESL_ADDRESS = 0xFC3, ADRESH_ADDRESS = 0xFC4;
constexpr unsigned PIR1_ADDRESS = 0xF9E;
enum : uint8_t { ADON = 0x01, GO = 0x02, CHANNEL = 0x3C };
enum : uint8_t { VCFG0 = 0x10, VCFG1 = 0x20 }; // VREF+ on AN3, VREF- on AN2
enum : uint8_t { ADFM = 0x80, ADIF = 0x40 };

constexpr double SUPPLY_V = 5.0;
constexpr int CODES = 1024;
constexpr double CYCLES_PER_US = CYCLES_PER_SECOND / 1e6;
// Acquisition: amplifier settling, capacitor to half a code, and 20 ns for
// each degree from 25 to 85 degrees Celsius.
constexpr double AMPLIFIER_US = 0.2, WARM_US = 1.2;
constexpr double HOLD_PF = 25, INSIDE_OHM = 1e3 + 2e3;
// Parameter 130: TAD with a clock from the oscillator.
constexpr double TAD_MIN_US = 0.7, TAD_MAX_US = 25;
constexpr double RC_TAD_US = 1.0;
// Section 21.1: the next acquisition begins 3 TAD after a conversion.
constexpr int REST_TAD = 3, CONVERSION_TAD = 11;

// Cycles of the core to a TAD, by ADCS; 0 = the RC oscillator of the module.
constexpr double TAD_CYCLES[8] = {0.5, 2, 8, 0, 1, 4, 16, 0};
constexpr int ACQUISITION_TAD[8] = {0, 2, 4, 6, 8, 12, 16, 20};
constexpr int CHANNEL_PINS[] = {A + 0, A + 1, A + 2, A + 3, A + 5, E + 0, E + 1,
                                E + 2, B + 2, B + 3, B + 1, B + 4, B + 0};
constexpr int CHANNELS = 13;

unsigned value(unsigned address)
{
    return chip().cpu->registers[address]->get_value();
}

void set_value(unsigned address, unsigned number)
{
    chip().cpu->registers[address]->put_value(number);
}

double tad_cycles()
{
    double cycles = TAD_CYCLES[value(ADCON2_ADDRESS) & 7];
    return cycles > 0 ? cycles : RC_TAD_US * CYCLES_PER_US;
}

double charging_us(double source)
{
    return (source + INSIDE_OHM) * HOLD_PF * 1e-6;
}

// Something is due at a cycle of its own, also while an instruction runs.
class Alarm : public TriggerObject
{
public:
    explicit Alarm(void (*action)()) : action_(action)
    {
    }
    void set(uint64_t cycle)
    {
        clear();
        at_ = cycle;
        get_cycles().set_break(at_, this);
    }
    void clear()
    {
        if (at_)
            get_cycles().clear_break(this);
        at_ = 0;
    }
    void callback() override
    {
        at_ = 0;
        action_();
    }
    void callback_print() override
    {
    }

private:
    void (*action_)();
    uint64_t at_ = 0;
};

Alarm &conversion_starts()
{
    static Alarm alarm([] { adc().sample(); });
    return alarm;
}

Alarm &conversion_ends()
{
    static Alarm alarm([] { adc().finish(); });
    return alarm;
}

class ControlRegister : public sfr_register
{
public:
    explicit ControlRegister(Module *owner)
        : sfr_register(owner, "adcon0_model", "")
    {
    }
    void put(unsigned number) override
    {
        unsigned before = get_value();
        put_value(number & (ADON | GO | CHANNEL));
        adc().control(before, get_value());
    }
    void reset(RESET_TYPE) override
    {
        put_value(0);
        adc().abort();
    }
};

} // namespace

Adc &adc()
{
    static Adc instance;
    return instance;
}

void Adc::attach()
{
    auto *control = new ControlRegister(chip().cpu);
    control->address = ADCON0_ADDRESS;
    chip().cpu->registers[ADCON0_ADDRESS] = control;
}

int Adc::selected() const
{
    return (value(ADCON0_ADDRESS) & CHANNEL) >> 2;
}

double Adc::input(int channel) const
{
    return channel < CHANNELS ? pins().volts(CHANNEL_PINS[channel]) : held_;
}

double Adc::source_ohm(int channel) const
{
    return channel < CHANNELS ? pins().source_ohm(CHANNEL_PINS[channel]) : 0;
}

// What the capacitor has taken up of the input it is connected to.
void Adc::follow()
{
    for (const auto &hook : look_)
        hook();
    if (!(value(ADCON0_ADDRESS) & ADON) || chip().now() <= sampling_from_)
        return;
    double us = (chip().now() - sampling_from_) / CYCLES_PER_US;
    us = std::max(us - AMPLIFIER_US, 0.0);
    double aim = input(channel_);
    held_ =
        aim + (held_ - aim) * std::exp(-us / charging_us(source_ohm(channel_)));
}

void Adc::control(unsigned old_value, unsigned new_value)
{
    bool just_on = new_value & ~old_value & ADON;
    if (converting_ && (old_value ^ new_value) & CHANNEL)
        mistakes.add("A/D: channel changed during a conversion");
    if (converting_ && (new_value & (ADON | GO)) != (ADON | GO))
        abort();
    if (just_on || (!converting_ && selected() != channel_)) {
        if (!just_on)
            follow();
        channel_ = selected();
        sampling_from_ = std::max(sampling_from_, chip().now());
    }
    if (!(new_value & ADON)) {
        set_value(ADCON0_ADDRESS, new_value & ~GO);
        return;
    }
    if (new_value & ~old_value & GO && !converting_) {
        if (just_on)
            mistakes.add("A/D: GO set in the write that switches it on");
        start();
    }
}

void Adc::start()
{
    converting_ = true;
    clock_ = tad_cycles();
    setup_[0] = value(ADCON1_ADDRESS);
    setup_[1] = value(ADCON2_ADDRESS);
    double us = clock_ / CYCLES_PER_US;
    if (us < TAD_MIN_US || us > TAD_MAX_US)
        mistakes.add(text("A/D: TAD is %.2f us, 0.7 to 25 us wanted", us));
    int analogue = std::min<int>(15 - (setup_[0] & 0x0F), CHANNELS);
    if (channel_ >= analogue)
        mistakes.add(text("A/D: AN%d is not analogue", channel_));
    uint64_t wait = std::ceil(ACQUISITION_TAD[setup_[1] >> 3 & 7] * clock_);
    conversion_starts().set(chip().now() + wait + 1);
}

// The capacitor is taken off the input: this is what will be converted.
void Adc::sample()
{
    double needs = AMPLIFIER_US + WARM_US +
                   charging_us(source_ohm(channel_)) * std::log(2.0 * CODES);
    double had = 0;
    if (chip().now() > sampling_from_)
        had = (chip().now() - sampling_from_) / CYCLES_PER_US;
    if (had < needs)
        mistakes.add(
            text("A/D: %.2f us to acquire AN%d, which needs %.2f us, 3 TAD "
                 "after the last conversion",
                 had, channel_, needs));
    follow();
    double low = setup_[0] & VCFG1 ? input(2) : 0;
    double high = setup_[0] & VCFG0 ? input(3) : SUPPLY_V;
    double part = high > low ? (held_ - low) / (high - low) : 0;
    code_ = std::clamp(std::floor(part * CODES + 0.5), 0.0, CODES - 1.0);
    conversion_ends().set(chip().now() +
                          uint64_t(std::ceil(CONVERSION_TAD * clock_)) + 1);
}

void Adc::finish()
{
    unsigned code = unsigned(code_);
    converting_ = false;
    if (value(ADCON1_ADDRESS) != setup_[0] ||
        value(ADCON2_ADDRESS) != setup_[1])
        mistakes.add("A/D: ADCON1 or ADCON2 changed during a conversion");
    if (!(setup_[1] & ADFM))
        code <<= 6;
    set_value(ADRESH_ADDRESS, code >> 8);
    set_value(ADRESL_ADDRESS, code & 0xFF);
    set_value(ADCON0_ADDRESS, value(ADCON0_ADDRESS) & ~GO);
    Register *flags = chip().cpu->registers[PIR1_ADDRESS];
    flags->put(flags->get_value() | ADIF);
    channel_ = selected();
    sampling_from_ = chip().now() + uint64_t(std::ceil(REST_TAD * clock_));
}

void Adc::abort()
{
    conversion_starts().clear();
    conversion_ends().clear();
    if (converting_)
        sampling_from_ = chip().now() + uint64_t(std::ceil(REST_TAD * clock_));
    converting_ = false;
}

} // namespace lathe

int vl_adc_mistake(unsigned index, char *text, unsigned room)
{
    return lathe::adc().mistakes.copy(index, text, room);
}
