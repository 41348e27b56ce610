// SPDX-License-Identifier: Apache-2.0
// Motors, screws, slides and limit switches.  Lengths inside are half steps
// (a full step is two), so that half-step coil patterns are exact.

#ifndef VIRTUAL_LATHE_MACHINE_HH
#define VIRTUAL_LATHE_MACHINE_HH

#include "pins.hh"

#include <random>

namespace lathe
{

// One axis, from the coil pattern to the switch.
class Axis
{
public:
    void attach(int number, int switch_pin);
    void coils(uint64_t cycle, unsigned pattern);
    void set_power(bool on, uint64_t cycle);
    void set_slide(int64_t steps, int64_t backlash, int64_t slack);
    void set_switch(int64_t travel, bool broken);

    // Motor: full steps/s it starts at, reaches at most, and full steps/s2.
    double pull_in = 1100, pull_out = 1100, acceleration = 0;
    // Ends of the slide, half steps.
    int64_t stop_plus = 0, stop_minus = 0;
    vl_axis_state state = {};

private:
    void turn(uint64_t cycle, int half_steps);
    void follow(uint64_t cycle, int half_steps);
    void fault(uint64_t cycle, vl_fault_kind kind, int64_t value);
    void update_switch();

    int number_ = 0, switch_pin_ = 0;
    unsigned pattern_ = 0;
    int last_ring_ = -1; // ring index of the last valid pattern
    uint64_t moved_at_ = 0;
    double speed_ = 0; // full steps/s, with sign
    bool power_ = true;
    int64_t backlash_ = 0, travel_ = 0;
    bool contact_open_ = false, broken_ = false;
};

class Machine
{
public:
    void attach();
    Axis axes[2]; // 0 X, 1 Z
    std::vector<vl_move> moves;
    std::vector<vl_fault> faults;
    uint64_t bounce = 0; // cycles a contact bounces
    uint64_t noise = 0;  // mean cycles between pulses, 0 = none
    std::mt19937 random{1};
    void contact(int pin, bool open);
    void start_noise();

private:
    void noise_pulse();
    void bounce_once(int pin, uint64_t end);
    void set_contact(int pin, bool open);
    bool open_[PIN_COUNT] = {}, known_[PIN_COUNT] = {};
    uint64_t bounce_end_[PIN_COUNT] = {};
};

Machine &machine();

} // namespace lathe

#endif
