// SPDX-License-Identifier: Apache-2.0
// The USB serial interface engine of the PIC18F4550 (data sheet chapter 17):
// special function registers, buffer descriptors in dual-port RAM, and the
// answers to tokens from the bus.  usb_rules.cc keeps a list of mistakes:
// things the firmware does that the data sheet forbids or that race with the
// engine.

#ifndef VIRTUAL_LATHE_USB_ENGINE_HH
#define VIRTUAL_LATHE_USB_ENGINE_HH

#include "mistakes.hh"

namespace lathe
{

enum class Handshake { None = 0, Ack = 1, Nak = 2, Stall = 3 };
enum class Token { Out = 1, In = 9, Setup = 13 };

constexpr unsigned NO_ADDRESS = 0x100;

struct Packet {
    Token token = Token::In;
    unsigned address = 0, endpoint = 0;
    unsigned toggle = 0; // 0 or 1: DATA0 or DATA1
    std::vector<uint8_t> data = {};
    bool fresh = false; // never sent before: the device must not drop it
};

class UsbEngine
{
public:
    void attach();
    // The device shows itself on the bus: module on, pull-up on.
    bool connected() const;

    // A transaction in two halves.  begin() answers the token; for IN it
    // fills in data and toggle.  complete() is called when the last packet
    // has gone over the bus, and only if begin() answered Ack.
    Handshake begin(Packet &packet);
    void complete(const Packet &packet);

    void start_of_frame(unsigned number);
    void bus_reset(bool active);
    void bus_idle();     // 3 ms without any packet
    void bus_activity(); // resume signalling or a packet
    void host_error()
    {
        flag_error(0x10);
    } // BTOEF: bus turn-around

    unsigned read(unsigned address);
    void write(unsigned address, unsigned value);
    unsigned value(unsigned address) const
    {
        return regs_[address - UFRML];
    }
    void ram_read(unsigned address);
    void ram_written(unsigned address, unsigned old_value, unsigned value);
    void reset();
    void mistake(const std::string &text);
    Mistakes mistakes;

private:
    struct Descriptor {
        unsigned stat, count, address, at;
    };
    Descriptor descriptor(unsigned endpoint, bool in) const;
    bool buffer_fits(const Descriptor &d, unsigned count);
    void write_back(const Descriptor &d, Token token, unsigned count);
    void push_status(uint8_t status);
    void pop_status();
    void raise(uint8_t flag);
    void flag_error(uint8_t flag);
    void update_interrupt();
    void write_ucon(uint8_t value);
    void write_uir(uint8_t value);
    void endpoint_changed(unsigned endpoint);
    void check_setup_refused();
    void check_refused();
    void check_suspend();
    void check_stall_handled(unsigned endpoint);
    void setup_seen(const std::vector<uint8_t> &data);
    void expect_address();
    bool at_rest() const;
    bool owned(unsigned address, std::string &what) const;
    void armed(unsigned at, const Descriptor &d);
    bool endpoint_on(unsigned endpoint, bool in) const;

    uint8_t &reg(unsigned address)
    {
        return regs_[address - UFRML];
    }
    uint8_t regs_[UEP0 + 16 - UFRML] = {};
    std::vector<uint8_t> fifo_; // USTAT entries, oldest first
    bool status_shown_ = false;
    bool status_read_ = false; // USTAT was read since it shows this entry
    bool idle_ = false;        // the bus has been quiet for 3 ms
    unsigned highest_ = 0;     // the highest endpoint that is on
    uint64_t last_pop_ = 0;    // cycle of the last TRNIF cleared
    uint64_t last_setup_ = 0;
    uint64_t last_stall_ = 0;
    uint64_t idle_end_ = 0;   // cycle of the last activity after idleness
    uint64_t clock_back_ = 0; // cycle from which ACTVIF can be cleared
    unsigned wanted_address_ = NO_ADDRESS;  // of the last SET_ADDRESS
    unsigned granted_address_ = NO_ADDRESS; // its status stage is over
    unsigned address_ticket_ = 0;
    bool set_address_open_ = false; // SET_ADDRESS without its status stage
    bool reset_seen_ = false;       // a bus reset nobody has handled yet
};

UsbEngine &usb_engine();

} // namespace lathe

#endif
