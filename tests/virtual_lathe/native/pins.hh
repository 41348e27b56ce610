// SPDX-License-Identifier: Apache-2.0
// The pins of the chip: what drives them from outside, what level they have,
// and who wants to know when that changes.

#ifndef VIRTUAL_LATHE_PINS_HH
#define VIRTUAL_LATHE_PINS_HH

#include "chip.hh"
#include "virtual_lathe.h"

namespace lathe
{

enum Port { A = 0, B = 8, C = 16, D = 24, E = 32 };
constexpr int PIN_COUNT = 40;

class Pins
{
public:
    // Called after each instruction that changed pins: the cycle of the
    // change, all levels, and which pins changed.
    using Listener = std::function<void(uint64_t, uint64_t, uint64_t)>;

    void attach();
    void listen(Listener listener)
    {
        listeners_.push_back(listener);
    }
    void drive(int pin, double volts, double ohms);
    void drive(int pin, vl_drive drive);
    bool exists(int pin) const;
    int level(int pin) const
    {
        return levels_ >> pin & 1;
    }
    // Voltage of the pin, and what it is driven through from outside.
    double volts(int pin) const;
    double source_ohm(int pin) const;
    uint64_t levels() const
    {
        return levels_;
    }
    void note(int pin, bool level);
    void port_d_pull_ups(bool on);

private:
    void settle();

    uint64_t levels_ = 0;
    uint64_t announced_ = 0;
    uint64_t open_ = 0;
    uint64_t changed_at_ = 0;
    bool port_d_pull_ups_ = false;
    std::vector<Listener> listeners_;
};

Pins &pins();

} // namespace lathe

#endif
