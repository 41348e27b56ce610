// SPDX-License-Identifier: Apache-2.0
// The simulated PIC18F4550 as the other parts of the shim see it: the one
// processor object of gpsim, its clock, and a queue of things to do at a
// given cycle.  gpsim keeps its state in globals, so there is one chip per
// process and everything here is reached through chip().

#ifndef VIRTUAL_LATHE_CHIP_HH
#define VIRTUAL_LATHE_CHIP_HH

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gpsim/interface.h>
#include <gpsim/sim_context.h>
#include <gpsim/pic-processor.h>
#include <gpsim/16bit-processors.h>
#include <gpsim/registers.h>
#include <gpsim/breakpoints.h>
#include <gpsim/clock_phase.h>
#include <gpsim/gpsim_time.h>
#include <gpsim/eeprom.h>
#include <gpsim/ioports.h>
#include <gpsim/stimuli.h>

namespace lathe
{

// 48 MHz core: four clocks an instruction cycle.
constexpr uint64_t CYCLES_PER_SECOND = 12000000;
constexpr uint64_t CYCLES_PER_MS = CYCLES_PER_SECOND / 1000;
constexpr uint64_t NEVER = ~uint64_t{0};
constexpr unsigned FLASH_BYTES = 0x8000;
constexpr unsigned RAM_BYTES = 0x800;
constexpr unsigned EEPROM_BYTES = 0x100;

// Addresses of special function registers, names as in the data sheet.
enum Sfr : unsigned {
    UFRML = 0xF66,
    UFRMH = 0xF67,
    UIR = 0xF68,
    UIE = 0xF69,
    UEIR = 0xF6A,
    UEIE = 0xF6B,
    USTAT = 0xF6C,
    UCON = 0xF6D,
    UADDR = 0xF6E,
    UCFG = 0xF6F,
    UEP0 = 0xF70,
    PORTA = 0xF80,
    PORTB = 0xF81,
    PORTC = 0xF82,
    PORTD = 0xF83,
    PORTE = 0xF84,
    PIR2 = 0xFA1,
    RCON_ADDRESS = 0xFD0,
    STKPTR = 0xFFC
};

// What the interrupts of one priority cost, in instruction cycles from the
// fetch at the vector to the end of its retfie.
struct InterruptCost {
    uint64_t entries = 0;
    uint64_t total = 0; // without the time of interrupts nested in it
    uint64_t worst = 0;
    uint64_t best = NEVER;
    uint64_t worst_at = 0; // cycle of the entry that cost most
};

class Chip
{
public:
    _16bit_processor *cpu = nullptr;

    bool load(const char *path);
    uint64_t now() const
    {
        return get_cycles().get();
    }

    // Runs until the clock reaches `until` (it may overshoot by the rest of
    // one instruction), a break address is reached or stop() is called.
    int run(uint64_t until);
    void stop(int reason)
    {
        stop_reason_ = reason;
        wake();
    }

    // Calls `action` at the first instruction boundary at or after `cycle`.
    void at(uint64_t cycle, std::function<void()> action);
    // Asks for the settle hooks to run after the present instruction.
    void wake()
    {
        attention_ = true;
    }
    // Called once after each instruction that called wake().
    void add_settle(std::function<void()> hook)
    {
        settle_.push_back(hook);
    }
    // Called after each reset of the processor, with gpsim's reset type.
    void add_on_reset(std::function<void(RESET_TYPE)> hook);

    void reset(RESET_TYPE type);
    void note_reset(RESET_TYPE type);
    // Holds the core until `cycle`, as a flash write does.
    void stall(uint64_t cycle)
    {
        stalled_until_ = cycle;
    }
    // Looks through the program again after it was changed.
    void classify();
    void set_break(unsigned address, bool enabled);
    void clear_statistics();

    InterruptCost interrupts[2];   // 0 low, 1 high priority
    unsigned stack_depth_max = 0;  // of the hardware return stack
    std::vector<uint8_t> executed; // one flag per program word
    std::vector<std::pair<uint64_t, int>> resets; // cycle, RESET_TYPE

private:
    enum Flag : uint8_t {
        BREAK = 1,
        RETFIE = 2,
        TBLWT = 4,
        CLRWDT = 8,
        TBLRD = 16
    };
    struct Entry {
        int level;
        uint64_t start;
        uint64_t nested;
    };

    void attend();
    void stand_still(uint64_t until);
    void note_instruction(uint8_t flag);
    void finish_reset();
    void repair_compare();
    void start_watchdog();
    void feed_watchdog();
    void watch();
    bool boundary(uint64_t until, bool first);
    void enter_interrupt(int stack_before, uint64_t start);
    void leave_interrupt();
    void run_events();

    int stop_reason_ = 0;
    bool attention_ = false;
    bool reset_seen_ = false;
    bool resetting_ = false;
    uint8_t rcon_next_ = 0;
    uint8_t stkptr_next_ = 0;
    uint64_t stalled_until_ = 0;
    bool watchdog_always_ = false;
    uint64_t watchdog_period_ = 0;
    uint64_t watchdog_deadline_ = 0;
    bool pending_check_ = false;
    uint64_t next_event_ = NEVER;
    std::multimap<uint64_t, std::function<void()>> events_;
    std::vector<std::function<void()>> settle_;
    std::vector<std::function<void(RESET_TYPE)>> on_reset_;
    std::vector<Entry> nesting_;
    std::vector<uint8_t> flags_;
};

Chip &chip();

// Hands out the oldest entries of a log and forgets them; returns how many.
template <typename T> int take(std::vector<T> &from, T *entries, int room)
{
    int count = std::min<int>(room, from.size());
    std::copy_n(from.begin(), count, entries);
    from.erase(from.begin(), from.begin() + count);
    return count;
}

} // namespace lathe

#endif
