// SPDX-License-Identifier: Apache-2.0
// gpsim 0.31 never matches a compare value of 0x0000: its timer looks for
// values above the last roll-over only.  Here the match of value 0 is made at
// the roll-over of Timer 1, for both compare modules.

#include "chip.hh"

namespace lathe
{

namespace
{

constexpr unsigned CCPR2L_ADDRESS = 0xFBB, CCPR1L_ADDRESS = 0xFBE;
constexpr unsigned PIR1_ADDRESS = 0xF9E;
constexpr unsigned T1CON_ADDRESS = 0xFCD;
constexpr uint8_t CCP2IF = 0x01, CCP1IF = 0x04;
constexpr uint8_t TMR1ON = 0x01, TMR1CS = 0x02, PRESCALER = 0x30;
constexpr unsigned COMPARE_MASK = 0x0C, COMPARE = 0x08;

class ZeroCompare : public TriggerObject
{
public:
    ZeroCompare(unsigned low, unsigned flags, uint8_t bit, CCPCON &control)
        : low_(low), flags_(flags), bit_(bit), control_(control)
    {
    }

    void value_written()
    {
        if (at_) {
            get_cycles().clear_break(this);
            at_ = 0;
        }
        unsigned timer = chip().cpu->registers[T1CON_ADDRESS]->get_value();
        bool runs = timer & TMR1ON && !(timer & (TMR1CS | PRESCALER));
        if (!wanted() || !runs)
            return;
        unsigned now =
            chip().cpu->tmr1l.get_value() | chip().cpu->tmr1h.get_value() << 8;
        at_ = chip().now() + 0x10000 - (now & 0xFFFF);
        get_cycles().set_break(at_, this);
    }

    void callback() override
    {
        at_ = 0;
        if (!wanted())
            return;
        Register *flags = chip().cpu->registers[flags_];
        flags->put(flags->get_value() | bit_);
        at_ = chip().now() + 0x10000;
        get_cycles().set_break(at_, this);
    }

    void callback_print() override
    {
    }

private:
    bool wanted() const
    {
        Register **r = chip().cpu->registers;
        return (control_.value.get() & COMPARE_MASK) == COMPARE &&
               r[low_]->get_value() == 0 && r[low_ + 1]->get_value() == 0;
    }

    unsigned low_, flags_;
    uint8_t bit_;
    CCPCON &control_;
    uint64_t at_ = 0;
};

// Half of a compare value: tells the model after gpsim has taken it.
class CompareByte : public sfr_register
{
public:
    CompareByte(Module *owner, Register *inner, ZeroCompare &model)
        : sfr_register(owner, (inner->name() + "_model").c_str(), ""),
          inner_(inner), model_(model)
    {
    }
    unsigned get() override
    {
        return inner_->get();
    }
    unsigned get_value() override
    {
        return inner_->get_value();
    }
    void put(unsigned v) override
    {
        inner_->put(v);
        model_.value_written();
    }
    void put_value(unsigned v) override
    {
        inner_->put_value(v);
        model_.value_written();
    }
    void reset(RESET_TYPE type) override
    {
        inner_->reset(type);
        model_.value_written();
    }

private:
    Register *inner_;
    ZeroCompare &model_;
};

void install(unsigned low, ZeroCompare &model)
{
    Register **registers = chip().cpu->registers;
    for (unsigned address : {low, low + 1}) {
        auto *byte = new CompareByte(chip().cpu, registers[address], model);
        byte->address = address;
        registers[address] = byte;
    }
}

} // namespace

void Chip::repair_compare()
{
    static ZeroCompare first(CCPR1L_ADDRESS, PIR1_ADDRESS, CCP1IF,
                             cpu->ccp1con);
    static ZeroCompare second(CCPR2L_ADDRESS, PIR2, CCP2IF, cpu->ccp2con);
    install(CCPR1L_ADDRESS, first);
    install(CCPR2L_ADDRESS, second);
}

} // namespace lathe
