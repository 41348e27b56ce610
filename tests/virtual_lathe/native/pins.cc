// SPDX-License-Identifier: Apache-2.0
// Each pin gets a node with one stimulus of ours on it.  gpsim solves the
// node; we see the resulting voltage, so pull-ups and directions count.

#include "pins.hh"

namespace lathe
{

namespace
{

constexpr double SUPPLY_V = 5.0;
constexpr double LEVEL_V = 2.5;
constexpr double WIRE_OHM = 10.0;
constexpr double OPEN_OHM = 1e9;
// Weak pull-up: 50 to 400 uA at 5 V by the data sheet; 25 kOhm is between.
constexpr double PULL_UP_OHM = 25e3;
constexpr unsigned RDPU = 0x80; // PORTE bit 7: PORTD pull-ups on

class Probe : public stimulus
{
public:
    Probe(const char *name, int pin) : stimulus(name, 0.0, OPEN_OHM), pin_(pin)
    {
    }
    void set_nodeVoltage(double volts) override
    {
        nodeVoltage = volts;
        pins().note(pin_, volts > LEVEL_V);
    }

private:
    int pin_;
};

// Pins that the 40-pin chip has: no RA7, RC3 (VUSB), RE3 (MCLR) and above.
constexpr unsigned PORT_PINS[] = {0x7F, 0xFF, 0xF7, 0xFF, 0x07};

Probe *probes[PIN_COUNT];

// PORTE with its bit 7, which gpsim does not have.
class PortE : public sfr_register
{
public:
    PortE(Module *owner, Register *inner)
        : sfr_register(owner, "porte_model", ""), inner_(inner)
    {
    }
    unsigned get() override
    {
        return merge(inner_->get());
    }
    unsigned get_value() override
    {
        return merge(inner_->get_value());
    }
    void put(unsigned value) override
    {
        split(value);
        inner_->put(value);
    }
    void put_value(unsigned value) override
    {
        split(value);
        inner_->put_value(value);
    }
    void reset(RESET_TYPE type) override
    {
        split(0);
        inner_->reset(type);
    }

private:
    unsigned merge(unsigned value) const
    {
        return (value & 0x0F) | rdpu_;
    }
    void split(unsigned value)
    {
        rdpu_ = value & RDPU;
        pins().port_d_pull_ups(rdpu_);
    }
    Register *inner_;
    unsigned rdpu_ = 0;
};

} // namespace

Pins &pins()
{
    static Pins instance;
    return instance;
}

void Pins::attach()
{
    for (int pin = 0; pin < PIN_COUNT; pin++) {
        Register *port = chip().cpu->registers[PORTA + pin / 8];
        auto *module = dynamic_cast<PortModule *>(port);
        IOPIN *iopin = module ? module->getPin(pin % 8) : nullptr;
        if (!iopin || !(PORT_PINS[pin / 8] >> pin % 8 & 1))
            continue;
        char name[] = {'R', char('A' + pin / 8), char('0' + pin % 8), 0};
        auto *node = new Stimulus_Node((std::string("node_") + name).c_str());
        probes[pin] = new Probe(name, pin);
        open_ |= uint64_t{1} << pin;
        node->attach_stimulus(iopin);
        node->attach_stimulus(probes[pin]);
        node->update();
    }
    announced_ = levels_;
    chip().add_settle([this] { settle(); });
    auto *port_e = new PortE(chip().cpu, chip().cpu->registers[PORTE]);
    port_e->address = PORTE;
    chip().cpu->registers[PORTE] = port_e;
}

bool Pins::exists(int pin) const
{
    return pin >= 0 && pin < PIN_COUNT && probes[pin];
}

double Pins::volts(int pin) const
{
    return probes[pin]->get_nodeVoltage();
}

double Pins::source_ohm(int pin) const
{
    return probes[pin]->get_Zth();
}

void Pins::note(int pin, bool level)
{
    uint64_t bit = uint64_t{1} << pin;
    if (bool(levels_ & bit) == level)
        return;
    levels_ ^= bit;
    changed_at_ = chip().now();
    chip().wake();
}

void Pins::settle()
{
    // A listener may drive pins (a switch closes): go on until it is quiet.
    while (levels_ != announced_) {
        uint64_t changed = levels_ ^ announced_;
        announced_ = levels_;
        for (const auto &listener : listeners_)
            listener(changed_at_, announced_, changed);
    }
}

void Pins::drive(int pin, double volts, double ohms)
{
    open_ &= ~(uint64_t{1} << pin);
    if (probes[pin]->get_Vth() == volts && probes[pin]->get_Zth() == ohms)
        return;
    probes[pin]->set_Vth(volts);
    probes[pin]->set_Zth(ohms);
    probes[pin]->updateNode();
}

void Pins::drive(int pin, vl_drive kind)
{
    if (kind != VL_OPEN) {
        drive(pin, kind == VL_HIGH ? SUPPLY_V : 0.0, WIRE_OHM);
        return;
    }
    bool pulled = pin / 8 == D / 8 && port_d_pull_ups_;
    drive(pin, pulled ? SUPPLY_V : 0.0, pulled ? PULL_UP_OHM : OPEN_OHM);
    open_ |= uint64_t{1} << pin;
}

// gpsim has no pull-ups on PORTD.
void Pins::port_d_pull_ups(bool on)
{
    if (on == port_d_pull_ups_)
        return;
    port_d_pull_ups_ = on;
    for (int pin = D; pin < D + 8; pin++) {
        if (probes[pin] && open_ >> pin & 1)
            drive(pin, VL_OPEN);
    }
}

} // namespace lathe

using lathe::pins;

namespace
{

constexpr size_t PIN_LOG_MAX = 1 << 20;
std::vector<vl_pin_change> pin_log;
size_t pin_log_taken;
uint64_t pin_log_mask;

} // namespace

int vl_pin_drive(int pin, int drive)
{
    if (!pins().exists(pin) || drive < VL_LOW || drive > VL_OPEN)
        return -1;
    pins().drive(pin, static_cast<vl_drive>(drive));
    return 0;
}

int vl_pin_drive_volts(int pin, double volts, double ohms)
{
    if (!pins().exists(pin))
        return -1;
    pins().drive(pin, volts, ohms);
    return 0;
}

int vl_pin_level(int pin)
{
    return pins().exists(pin) ? pins().level(pin) : -1;
}

uint64_t vl_pin_levels(void)
{
    return pins().levels();
}

void vl_pin_log(uint64_t mask)
{
    static bool listening = false;
    if (!listening) {
        listening = true;
        pins().listen([](uint64_t cycle, uint64_t levels, uint64_t changed) {
            if (changed & pin_log_mask && pin_log.size() < PIN_LOG_MAX)
                pin_log.push_back({cycle, levels});
        });
    }
    pin_log_mask = mask;
    pin_log.clear();
    pin_log_taken = 0;
}

int vl_pin_changes(struct vl_pin_change *entries, int room)
{
    int count = 0;
    while (count < room && pin_log_taken < pin_log.size())
        entries[count++] = pin_log[pin_log_taken++];
    if (pin_log_taken == pin_log.size()) {
        pin_log.clear();
        pin_log_taken = 0;
    }
    return count;
}
