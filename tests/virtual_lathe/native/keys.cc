// SPDX-License-Identifier: Apache-2.0
// Eight keys on one wire, each to ground:
//
//   RA0 --+--1k--+
//       100 nF   |
//        GND     |
//   5 V ---2k2---+--330--+--390--+--620--+--910--+--1k5--+--3k--+--9k1--+
//                |       |       |       |       |       |      |       |
//              key 0   key 1   key 2   key 3   key 4   key 5  key 6   key 7
//
// Key k pulls to about k/8 of the supply; of two keys the lower one counts.
// The capacitor makes every change take 0.1 to 0.9 ms, and evens out what
// the contacts bounce.

#include "keys.hh"

#include "adc.hh"
#include "machine.hh"

#include <algorithm>
#include <cmath>

namespace lathe
{

namespace
{

constexpr int LADDER_PIN = A + 0;
constexpr int KEYS = 8;
constexpr double SUPPLY_V = 5.0, PULL_UP_OHM = 2200, SERIES_OHM = 1000;
constexpr double CAPACITOR_F = 100e-9;
// From the ladder's upper end to key k.
constexpr double KEY_OHM[KEYS] = {0, 330, 720, 1340, 2250, 3750, 6750, 15850};
// The capacitor is as good as a wire to the converter's 25 pF.
constexpr double PIN_OHM = 1;
// After so many time constants the pin is called settled.
constexpr double SETTLED = 8;

} // namespace

Keys &keys()
{
    static Keys instance;
    return instance;
}

double Keys::aim() const
{
    for (int key = 0; key < KEYS; key++) {
        if (contacts_ >> key & 1)
            return SUPPLY_V * KEY_OHM[key] / (PULL_UP_OHM + KEY_OHM[key]);
    }
    return SUPPLY_V;
}

double Keys::source_ohm() const
{
    for (int key = 0; key < KEYS; key++) {
        if (contacts_ >> key & 1)
            return PULL_UP_OHM * KEY_OHM[key] / (PULL_UP_OHM + KEY_OHM[key]);
    }
    return PULL_UP_OHM;
}

// Lets the capacitor charge up to now.
void Keys::advance()
{
    double seconds = double(chip().now() - since_) / CYCLES_PER_SECOND;
    double constant = (source_ohm() + SERIES_OHM) * CAPACITOR_F;
    volts_ = aim() + (volts_ - aim()) * std::exp(-seconds / constant);
    since_ = chip().now();
}

void Keys::refresh()
{
    advance();
    pins().drive(LADDER_PIN, volts_, PIN_OHM);
}

void Keys::set_contacts(unsigned contacts)
{
    refresh();
    contacts_ = contacts;
    double constant = (source_ohm() + SERIES_OHM) * CAPACITOR_F;
    uint64_t settled = std::ceil(SETTLED * constant * CYCLES_PER_SECOND);
    chip().at(chip().now() + settled, [this] { refresh(); });
}

void Keys::bounce()
{
    unsigned ticket = ++ticket_;
    if (chip().now() >= bounce_end_) {
        bouncing_ = 0;
        set_contacts(wanted_);
        return;
    }
    set_contacts((wanted_ & ~bouncing_) | (machine().random() & bouncing_));
    uint64_t wait = 1 + machine().random() % (machine().bounce / 8 + 1);
    chip().at(std::min(bounce_end_, chip().now() + wait), [this, ticket] {
        if (ticket == ticket_)
            bounce();
    });
}

void Keys::hold(unsigned wanted)
{
    bouncing_ |= wanted_ ^ wanted;
    wanted_ = wanted;
    bounce_end_ = chip().now() + machine().bounce;
    bounce();
}

void Keys::attach()
{
    since_ = chip().now();
    adc().before_sampling([this] { refresh(); });
    chip().add_on_reset([this](RESET_TYPE type) {
        // The supply was gone: the capacitor is empty.
        if (type == POR_RESET)
            volts_ = 0;
    });
    set_contacts(0);
}

} // namespace lathe

void vl_keys_attach(void)
{
    lathe::keys().attach();
}

void vl_keys_hold(unsigned held)
{
    lathe::keys().hold(held);
}
