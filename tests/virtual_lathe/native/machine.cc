// SPDX-License-Identifier: Apache-2.0
// The rotor turns to the pattern of its coils if it is strong and quick
// enough; whatever it does not do is a lost step.
//
//   coils -> rotor --(play: slack 0..backlash)--> slide -> switch
//
// Positive is away from the chuck (Z) and from the spindle axis (X).  The
// slide's position 0 is where the switch opens on the way in the negative
// direction; it closes when the slide gets beyond +travel.  With a backlash
// of b full steps the step that closes the switch is therefore followed, in
// the other direction, by b steps that move nothing, `travel` steps in which
// the switch stays pressed, and one more that opens it: b + travel + 1.

#include "machine.hh"

#include "probe.hh"

#include <algorithm>
#include <cmath>

namespace lathe
{

namespace
{

constexpr int X_COILS = D + 0, Z_COILS = B + 0;
constexpr int X_SWITCH = B + 4, Z_SWITCH = B + 5;
constexpr size_t FAULTS_MAX = 1000;
constexpr int RING = 8;
constexpr int NO_CURRENT = -1, ILLEGAL = -2;

// Place of a coil pattern in the half-step ring 5,1,9,8,10,2,6,4.
constexpr int RING_INDEX[16] = {
    NO_CURRENT, 1, 5, ILLEGAL, 7,       0,       6,       ILLEGAL,
    3,          2, 4, ILLEGAL, ILLEGAL, ILLEGAL, ILLEGAL, ILLEGAL};

int64_t floor_mod(int64_t a, int64_t b)
{
    return ((a % b) + b) % b;
}

// Shortest way round the ring, -4 < result <= 4.
int ring_distance(int64_t from, int to)
{
    int d = int(floor_mod(to - from, RING));
    return d > RING / 2 ? d - RING : d;
}

// One step of rate v after speed u: possible from standstill up to the
// pull-in rate, above it only with the acceleration the motor has.
bool motor_can(const Axis &axis, double u, double v, double steps)
{
    if (std::fabs(v) <= axis.pull_in)
        return true;
    if (std::fabs(v) > axis.pull_out || u * v < 0)
        return false;
    double base = std::max(std::fabs(u), axis.pull_in);
    return v * v <= base * base + 2 * axis.acceleration * steps;
}

} // namespace

Machine &machine()
{
    static Machine instance;
    return instance;
}

void Axis::attach(int number, int switch_pin)
{
    number_ = number;
    switch_pin_ = switch_pin;
    update_switch();
}

void Axis::fault(uint64_t cycle, vl_fault_kind kind, int64_t value)
{
    if (machine().faults.size() < FAULTS_MAX)
        machine().faults.push_back({cycle, number_, kind, value});
}

void Axis::set_slide(int64_t steps, int64_t backlash, int64_t slack)
{
    backlash_ = backlash * 2;
    state.slack = std::clamp<int64_t>(slack * 2, 0, backlash_);
    state.slide = steps * 2;
    // Standing on a two-phase position, pattern 5.
    state.rotor = 0;
    state.commanded = 0;
    contact_open_ = state.slide > travel_;
    update_switch();
}

void Axis::set_switch(int64_t travel, bool broken)
{
    travel_ = travel * 2;
    broken_ = broken;
    contact_open_ = state.slide > travel_;
    update_switch();
}

void Axis::update_switch()
{
    if (state.slide > travel_)
        contact_open_ = true;
    if (state.slide <= 0)
        contact_open_ = false;
    state.pressed = contact_open_;
    machine().contact(switch_pin_, contact_open_ || broken_);
}

void Axis::set_power(bool on, uint64_t cycle)
{
    power_ = on;
    unsigned pattern = pattern_;
    pattern_ = 0;
    if (on)
        coils(cycle, pattern);
    pattern_ = pattern;
}

void Axis::coils(uint64_t cycle, unsigned pattern)
{
    if (pattern == pattern_)
        return;
    pattern_ = pattern;
    int index = RING_INDEX[pattern & 15];
    if (index == ILLEGAL) {
        state.illegal_patterns++;
        fault(cycle, VL_FAULT_PATTERN, pattern);
    }
    if (index < 0)
        return;
    if (last_ring_ >= 0) {
        int jump = ring_distance(last_ring_, index);
        state.commanded += jump;
        if (std::abs(jump) > 2) {
            state.jumps++;
            fault(cycle, VL_FAULT_JUMP, jump);
        }
    } else {
        state.commanded = state.rotor + ring_distance(state.rotor, index);
    }
    last_ring_ = index;
    state.steps++;
    if (power_)
        follow(cycle, ring_distance(state.rotor, index));
}

void Axis::follow(uint64_t cycle, int half_steps)
{
    if (half_steps == 0)
        return;
    double seconds = double(cycle - moved_at_) / CYCLES_PER_SECOND;
    double rate = half_steps / 2.0 / std::max(seconds, 1e-7);
    moved_at_ = cycle;
    bool possible = std::abs(half_steps) <= 2 &&
                    motor_can(*this, speed_, rate, std::abs(half_steps) / 2.0);
    if (!possible) {
        state.lost_steps++;
        fault(cycle, VL_FAULT_LOST_STEP, int64_t(rate));
        speed_ = 0;
        return;
    }
    speed_ = rate;
    state.fastest = std::max(state.fastest, std::fabs(rate));
    turn(cycle, half_steps);
}

void Axis::turn(uint64_t cycle, int half_steps)
{
    int64_t slack = state.slack + half_steps;
    int64_t push = slack > backlash_ ? slack - backlash_
                   : slack < 0       ? slack
                                     : 0;
    int64_t slide = state.slide + push;
    if (slide > stop_plus || slide < stop_minus) {
        state.lost_steps++;
        state.end_stops++;
        fault(cycle, VL_FAULT_END_STOP, slide / 2);
        return;
    }
    state.rotor += half_steps;
    state.slack = slack - push;
    if (push == 0)
        return;
    state.slide = slide;
    update_switch();
    machine().moves.push_back(
        {cycle, machine().axes[0].state.slide, machine().axes[1].state.slide});
    probe().look();
}

// ---- contacts ---------------------------------------------------------------

void Machine::set_contact(int pin, bool open)
{
    if (open && pin == PROBE_PIN)
        pins().drive(pin, 5.0, PROBE_PULL_UP_OHM);
    else
        pins().drive(pin, open ? VL_OPEN : VL_LOW);
}

void Machine::contact(int pin, bool open)
{
    bool first = !known_[pin];
    if (!first && open_[pin] == open)
        return;
    known_[pin] = true;
    open_[pin] = open;
    if (bounce == 0 || first) {
        set_contact(pin, open);
        return;
    }
    bounce_end_[pin] = chip().now() + bounce;
    bounce_once(pin, bounce_end_[pin]);
}

void Machine::bounce_once(int pin, uint64_t end)
{
    if (end != bounce_end_[pin])
        return;
    uint64_t now = chip().now();
    if (now >= end) {
        set_contact(pin, open_[pin]);
        return;
    }
    set_contact(pin, random() & 1);
    uint64_t wait = 1 + random() % (bounce / 8 + 1);
    chip().at(std::min(end, now + wait),
              [this, pin, end] { bounce_once(pin, end); });
}

void Machine::start_noise()
{
    if (noise)
        chip().at(chip().now() + 1 + random() % (2 * noise),
                  [this] { noise_pulse(); });
}

// A pulse of 1 to 10 us with the wrong level on one of the switch lines.
void Machine::noise_pulse()
{
    int pin = random() & 1 ? X_SWITCH : Z_SWITCH;
    set_contact(pin, !open_[pin]);
    chip().at(chip().now() + 12 + random() % 109, [this, pin] {
        if (chip().now() >= bounce_end_[pin])
            set_contact(pin, open_[pin]);
    });
    start_noise();
}

void Machine::attach()
{
    axes[0].attach(0, X_SWITCH);
    axes[1].attach(1, Z_SWITCH);
    contact(PROBE_PIN, true);
    pins().listen([this](uint64_t cycle, uint64_t levels, uint64_t changed) {
        if (changed >> X_COILS & 15)
            axes[0].coils(cycle, levels >> X_COILS & 15);
        if (changed >> Z_COILS & 15)
            axes[1].coils(cycle, levels >> Z_COILS & 15);
    });
}

} // namespace lathe

using lathe::machine;

namespace
{

bool is_axis(int axis)
{
    return axis == VL_X || axis == VL_Z;
}

} // namespace

void vl_machine_attach(void)
{
    machine().attach();
}

int vl_axis_setup(int axis, const struct vl_axis_setup *setup)
{
    if (!is_axis(axis))
        return -1;
    lathe::Axis &a = machine().axes[axis];
    a.stop_plus = int64_t(setup->stop_plus) * 2;
    a.stop_minus = int64_t(setup->stop_minus) * 2;
    a.pull_in = setup->pull_in;
    a.pull_out = setup->pull_out;
    a.acceleration = setup->acceleration;
    a.set_slide(setup->slide, setup->backlash, setup->slack);
    a.set_switch(setup->switch_travel, setup->switch_broken);
    return 0;
}

int vl_axis_read(int axis, struct vl_axis_state *state)
{
    if (!is_axis(axis))
        return -1;
    *state = machine().axes[axis].state;
    return 0;
}

int vl_switch_broken(int axis, int broken, int switch_travel)
{
    if (!is_axis(axis))
        return -1;
    machine().axes[axis].set_switch(switch_travel, broken);
    return 0;
}

void vl_motor_power(int on)
{
    for (auto &axis : machine().axes)
        axis.set_power(on, lathe::chip().now());
}

void vl_switch_quality(unsigned bounce_us, unsigned noise_hz, unsigned seed)
{
    machine().random.seed(seed);
    machine().bounce = uint64_t(bounce_us) * 12;
    bool was_off = machine().noise == 0;
    machine().noise = noise_hz ? lathe::CYCLES_PER_SECOND / noise_hz : 0;
    if (was_off)
        machine().start_noise();
}

int vl_moves(struct vl_move *entries, int room)
{
    return lathe::take(machine().moves, entries, room);
}

int vl_faults(struct vl_fault *entries, int room)
{
    return lathe::take(machine().faults, entries, room);
}
