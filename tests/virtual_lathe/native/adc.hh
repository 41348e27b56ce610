// SPDX-License-Identifier: Apache-2.0
// The A/D converter of the PIC18F4550 (data sheet chapter 21), in the place
// of gpsim's: with a holding capacitor that takes time to follow the input,
// 1,024 steps from VREF- to VREF+, and a list of what the data sheet forbids.

#ifndef VIRTUAL_LATHE_ADC_HH
#define VIRTUAL_LATHE_ADC_HH

#include "mistakes.hh"

namespace lathe
{

class Adc
{
public:
    void attach();
    // Called before the converter looks at its inputs, so that a model whose
    // voltage moves can bring its pin up to date.
    void before_sampling(std::function<void()> hook)
    {
        look_.push_back(hook);
    }
    // A write to ADCON0 by an instruction.
    void control(unsigned old_value, unsigned value);
    void abort();
    void sample();
    void finish();
    Mistakes mistakes;

private:
    int selected() const;
    double input(int channel) const;
    double source_ohm(int channel) const;
    void follow();
    void start();
    void check_start(bool just_on, double cycles);

    std::vector<std::function<void()>> look_;
    bool converting_ = false;
    double held_ = 0;            // volts on the holding capacitor
    double clock_ = 0;           // TAD of this conversion, cycles
    uint64_t sampling_from_ = 0; // cycle in which it was connected
    int channel_ = 0;            // that it is connected to
    unsigned setup_[2] = {};     // ADCON1 and ADCON2 at the start
    double code_ = 0;            // result of this conversion, 0..1023
};

Adc &adc();

} // namespace lathe

#endif
