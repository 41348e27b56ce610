// SPDX-License-Identifier: Apache-2.0
// See usb_engine.hh.  Section and table numbers are those of data sheet
// DS39632E.

#include "usb_engine.hh"
#include "usb_registers.hh"

#include <algorithm>
#include <iterator>

namespace lathe
{

namespace
{

constexpr uint8_t USBIF = 0x20;
// Section 17.5.1.1: ACTVIF stays set until the engine's clock is back.
constexpr uint64_t CLOCK_BACK_CYCLES = 60;
// Section 17.2.3: TRNIF comes back at most 6 cycles after it was cleared.
constexpr uint64_t TRNIF_AGAIN_CYCLES = 6;

class UsbRegister : public sfr_register
{
public:
    UsbRegister(Module *owner, unsigned where)
        : sfr_register(owner, ("usb_" + std::to_string(where)).c_str(), "")
    {
        address = where;
    }
    unsigned get() override
    {
        return usb_engine().read(address);
    }
    unsigned get_value() override
    {
        return usb_engine().value(address);
    }
    void put(unsigned v) override
    {
        usb_engine().write(address, v);
    }
    void put_value(unsigned v) override
    {
        usb_engine().write(address, v);
    }
    void reset(RESET_TYPE) override
    {
    }
};

class UsbRam : public Register
{
public:
    UsbRam(Module *owner, unsigned where)
        : Register(owner, ("usb_ram_" + std::to_string(where)).c_str())
    {
        address = where;
    }
    unsigned get() override
    {
        usb_engine().ram_read(address);
        return value.get();
    }
    void put(unsigned v) override
    {
        unsigned before = value.get();
        value.put(v & 0xFF);
        usb_engine().ram_written(address, before, v & 0xFF);
    }
    void put_value(unsigned v) override
    {
        value.put(v & 0xFF);
    }
    REGISTER_TYPES isa() override
    {
        return FILE_REGISTER;
    }
};

UsbRam *dual_port[RAM_LAST - RAM_FIRST + 1];

} // namespace

unsigned ram(unsigned address)
{
    bool inside = address >= RAM_FIRST && address <= RAM_LAST;
    return inside ? dual_port[address - RAM_FIRST]->value.get() : 0;
}

void set_ram(unsigned address, unsigned value)
{
    if (address >= RAM_FIRST && address <= RAM_LAST)
        dual_port[address - RAM_FIRST]->value.put(value & 0xFF);
}

UsbEngine &usb_engine()
{
    static UsbEngine instance;
    return instance;
}

void UsbEngine::attach()
{
    Register **registers = chip().cpu->registers;
    for (unsigned address = UFRML; address < UEP0 + ENDPOINTS; address++)
        registers[address] = new UsbRegister(chip().cpu, address);
    for (unsigned address = RAM_FIRST; address <= RAM_LAST; address++) {
        auto *byte = new UsbRam(chip().cpu, address);
        byte->value.put(registers[address]->get_value());
        registers[address] = byte;
        dual_port[address - RAM_FIRST] = byte;
    }
    chip().add_on_reset([this](RESET_TYPE) { reset(); });
}

void UsbEngine::reset()
{
    std::fill(std::begin(regs_), std::end(regs_), 0);
    fifo_.clear();
    status_shown_ = status_read_ = set_address_open_ = reset_seen_ = false;
    wanted_address_ = granted_address_ = NO_ADDRESS;
    address_ticket_++;
    highest_ = 0;
    idle_ = false;
}

bool UsbEngine::connected() const
{
    return value(UCON) & USBEN && value(UCFG) & UPUEN &&
           !(value(UCFG) & UTRDIS);
}

// ---- interrupts -----------------------------------------------------------

void UsbEngine::update_interrupt()
{
    if (reg(UEIR) & reg(UEIE))
        reg(UIR) |= UERRIF;
    else
        reg(UIR) &= ~UERRIF;
    Register *flags = chip().cpu->registers[PIR2];
    if (reg(UIR) & reg(UIE) && !(flags->get_value() & USBIF))
        flags->put(flags->get_value() | USBIF);
}

void UsbEngine::raise(uint8_t flag)
{
    reg(UIR) |= flag;
    update_interrupt();
}

void UsbEngine::flag_error(uint8_t flag)
{
    reg(UEIR) |= flag;
    update_interrupt();
}

void UsbEngine::push_status(uint8_t status)
{
    fifo_.push_back(status);
    if (fifo_.size() == 1) {
        status_shown_ = true;
        raise(TRNIF);
    }
}

// Clearing TRNIF advances the FIFO; the next entry shows up a little later.
void UsbEngine::pop_status()
{
    if (!status_shown_)
        return;
    if (!status_read_ && !reset_seen_)
        mistake("TRNIF cleared before USTAT was read: a transaction is lost");
    status_shown_ = status_read_ = false;
    last_pop_ = chip().now();
    fifo_.erase(fifo_.begin());
    if (fifo_.empty())
        return;
    chip().at(chip().now() + TRNIF_AGAIN_CYCLES, [this] {
        if (!fifo_.empty() && !status_shown_) {
            status_shown_ = true;
            raise(TRNIF);
        }
    });
}

// ---- registers, seen from the firmware ------------------------------------

unsigned UsbEngine::read(unsigned address)
{
    if (address != USTAT)
        return reg(address);
    if (!(reg(UIR) & TRNIF))
        mistake("USTAT read without TRNIF");
    status_read_ = true;
    return status_shown_ ? fifo_.front() : 0;
}

void UsbEngine::write_ucon(uint8_t value)
{
    uint8_t before = reg(UCON);
    uint8_t after = value & (PPBRST | USBEN | RESUME | SUSPND);
    after |= before & SE0;
    after |= before & value & PKTDIS; // firmware can only clear it
    reg(UCON) = after;
    if (after & ~before & SUSPND)
        check_suspend();
    if (before & ~after & SUSPND)
        clock_back_ = chip().now() + CLOCK_BACK_CYCLES;
    if (!(before & USBEN) && after & USBEN) {
        if (reg(UCFG) & PPB)
            mistake("ping-pong buffering is not modelled: use PPB = 0");
        if (!(reg(UCFG) & FSEN))
            mistake("FSEN is off: the device would run at low speed");
    }
    if (before & USBEN && !(after & USBEN)) {
        fifo_.clear();
        status_shown_ = false;
        reg(UIR) = 0;
        reg(UEIR) = 0;
        reg(UADDR) = 0;
        reg(UCON) &= ~PKTDIS;
    }
}

void UsbEngine::write_uir(uint8_t value)
{
    uint8_t before = reg(UIR);
    if (before & ACTVIF && (reg(UCON) & SUSPND || chip().now() < clock_back_))
        value |= ACTVIF;
    reg(UIR) = before & (value | UERRIF); // flags are only cleared
    if (before & ~reg(UIR) & TRNIF)
        pop_status();
    if (before & ~reg(UIR) & URSTIF)
        reset_seen_ = false;
    update_interrupt();
}

void UsbEngine::write(unsigned address, unsigned value)
{
    switch (address) {
    case UCON:
        write_ucon(value);
        return;
    case UIR:
        write_uir(value);
        return;
    case UEIR:
        reg(UEIR) &= value;
        update_interrupt();
        return;
    case USTAT:
    case UFRML:
    case UFRMH:
        mistake(text("write to read-only register 0x%03x", address));
        return;
    case UADDR:
        if (value & 0x7F && value != granted_address_ && !reset_seen_)
            mistake(
                set_address_open_
                    ? "UADDR written before the status stage of SET_ADDRESS"
                    : text("UADDR set to %u, which nobody asked for", value));
        reg(UADDR) = value & 0x7F;
        return;
    case UCFG:
        if (reg(UCON) & USBEN && value != reg(UCFG))
            mistake("UCFG changed while the module is on");
        reg(UCFG) = value;
        return;
    default:
        reg(address) = value;
        if (address >= UEP0)
            endpoint_changed(address - UEP0);
        update_interrupt();
    }
}

// ---- buffer descriptors ----------------------------------------------------

UsbEngine::Descriptor UsbEngine::descriptor(unsigned endpoint, bool in) const
{
    unsigned at = RAM_FIRST + (endpoint * 2 + in) * DESCRIPTOR_BYTES;
    unsigned stat = ram(at);
    return {stat, ram(at + 1) | (stat & 3) << 8, ram(at + 2) | ram(at + 3) << 8,
            at};
}

bool UsbEngine::endpoint_on(unsigned endpoint, bool in) const
{
    return value(UEP0 + endpoint) & (in ? EPINEN : EPOUTEN);
}

void UsbEngine::write_back(const Descriptor &d, Token token, unsigned count)
{
    set_ram(d.at + 1, count & 0xFF);
    set_ram(d.at, (d.stat & DTS) | unsigned(token) << 2 | (count >> 8 & 3));
}

} // namespace lathe
