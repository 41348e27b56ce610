// SPDX-License-Identifier: Apache-2.0
// Tool and work conduct as soon as there is no gap between them, whether or
// not the tool cuts.  It is looked at in each half step of a slide; metal that
// a move has cut is gone when the workpiece is told, see vl_probe_look().

#include "probe.hh"

#include "machine.hh"
#include "metal.hh"

namespace lathe
{

Probe &probe()
{
    static Probe instance;
    return instance;
}

void Probe::attach(int metal, double zero_x, double zero_z)
{
    metal_ = metal;
    zero_x_ = zero_x;
    zero_z_ = zero_z;
    look();
}

void Probe::look() const
{
    if (metal_ < 0 || shorted_) {
        machine().contact(PROBE_PIN, !shorted_);
        return;
    }
    double x = machine().axes[VL_X].state.slide / 2.0 - zero_x_;
    double z = machine().axes[VL_Z].state.slide / 2.0 - zero_z_;
    machine().contact(PROBE_PIN, !piece(metal_).touches(x, z));
}

void Probe::short_out(bool shorted)
{
    shorted_ = shorted;
    look();
}

} // namespace lathe

void vl_probe_attach(int metal, double zero_x, double zero_z)
{
    lathe::probe().attach(metal, zero_x, zero_z);
}

void vl_probe_look(void)
{
    lathe::probe().look();
}

void vl_probe_short(int shorted)
{
    lathe::probe().short_out(shorted);
}
