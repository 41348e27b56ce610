// SPDX-License-Identifier: Apache-2.0
// The contact sensor: a voltage on the tool, ground on the work.  RA1 is
// pulled low while they touch, and up by the board's resistor otherwise.

#ifndef VIRTUAL_LATHE_PROBE_HH
#define VIRTUAL_LATHE_PROBE_HH

#include "pins.hh"

namespace lathe
{

constexpr int PROBE_PIN = A + 1;
constexpr double PROBE_PULL_UP_OHM = 10e3;

class Probe
{
public:
    // zero_x, zero_z: machine position of the slides, full steps, at which
    // the tip is at the metal's (0, 0).
    void attach(int metal, double zero_x, double zero_z);
    // Looks where the tool is and sets the pin.
    void look() const;
    void short_out(bool shorted);

private:
    bool shorted_ = false;
    int metal_ = -1;
    double zero_x_ = 0, zero_z_ = 0;
};

Probe &probe();

} // namespace lathe

#endif
