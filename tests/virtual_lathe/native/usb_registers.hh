// SPDX-License-Identifier: Apache-2.0
// Bits and addresses of the USB module, for the two files of its model.

#ifndef VIRTUAL_LATHE_USB_REGISTERS_HH
#define VIRTUAL_LATHE_USB_REGISTERS_HH

#include "mistakes.hh"

namespace lathe
{

enum Ucon : uint8_t {
    SUSPND = 0x02,
    RESUME = 0x04,
    USBEN = 0x08,
    PKTDIS = 0x10,
    SE0 = 0x20,
    PPBRST = 0x40
};
enum Uir : uint8_t {
    URSTIF = 0x01,
    UERRIF = 0x02,
    ACTVIF = 0x04,
    TRNIF = 0x08,
    IDLEIF = 0x10,
    STALLIF = 0x20,
    SOFIF = 0x40
};
enum Ucfg : uint8_t { PPB = 0x03, FSEN = 0x04, UTRDIS = 0x08, UPUEN = 0x10 };
enum Uep : uint8_t {
    EPSTALL = 0x01,
    EPINEN = 0x02,
    EPOUTEN = 0x04,
    EPCONDIS = 0x08,
    EPHSHK = 0x10
};
enum Bdstat : uint8_t {
    BSTALL = 0x04,
    DTSEN = 0x08,
    INCDIS = 0x10,
    KEN = 0x20,
    DTS = 0x40,
    UOWN = 0x80
};
constexpr unsigned RAM_FIRST = 0x400, RAM_LAST = 0x7FF;
constexpr unsigned DESCRIPTOR_BYTES = 4, ENDPOINTS = 16;
constexpr unsigned PACKET_MAX = 64;
// Section 17.2.4: USTAT is a window on a FIFO of four entries.
constexpr size_t STATUS_FIFO_DEPTH = 4;

// The dual-port RAM as the engine sees it, whatever watches its addresses.
// Reading outside it gives 0, writing does nothing.
unsigned ram(unsigned address);
void set_ram(unsigned address, unsigned value);

} // namespace lathe

#endif
