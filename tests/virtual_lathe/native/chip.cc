// SPDX-License-Identifier: Apache-2.0
// Loads and runs the processor.  The loop is ours instead of gpsim's so that
// coverage, interrupt times and stack depth cost one table look-up per
// instruction, and so that time goes on while the core is stalled by a
// flash write or asleep.

#include "chip.hh"
#include "gpsim_versions.hh"
#include "nonvolatile.hh"
#include "virtual_lathe.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <unistd.h>

int initialize_gpsim_core();

namespace lathe
{

Chip &chip()
{
    static Chip instance;
    return instance;
}

namespace
{

// gpsim talks to standard output while it loads; nobody there expects it.
class Silence
{
public:
    Silence() : saved_(dup(STDOUT_FILENO))
    {
        fflush(stdout);
        int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        close(nowhere);
    }
    ~Silence()
    {
        fflush(stdout);
        dup2(saved_, STDOUT_FILENO);
        close(saved_);
        std::cout.setstate(std::ios::failbit);
    }

private:
    int saved_;
};

// Sits on an unused address so that gpsim tells it about every reset.
class ResetWitness : public sfr_register
{
public:
    explicit ResetWitness(Module *owner)
        : sfr_register(owner, "reset_witness", "reports resets")
    {
    }
    void reset(RESET_TYPE type) override
    {
        chip().note_reset(type);
    }
};

constexpr unsigned WITNESS_ADDRESS = 0xF60;
constexpr unsigned LOW_VECTOR_WORD = 0x0018 / 2;
// retfie takes two cycles; the second is still to come when we see it.
constexpr uint64_t RETFIE_REST = 1;

bool is_hex(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".hex") == 0;
}

} // namespace

bool Chip::load(const char *path)
{
    Silence silence;
    static bool initialized = false;
    if (!initialized) {
        initialize_gpsim_core();
        initialized = true;
    }
    Processor *loaded = nullptr;
    const char *type = is_hex(path) ? "p18f4550" : nullptr;
    CSimulationContext::GetContext()->LoadProgram(path, type, &loaded, "pic");
    cpu = dynamic_cast<_16bit_processor *>(loaded);
    if (!cpu || cpu->program_memory_size() * 2 != FLASH_BYTES)
        return false;
    // gpsim 0.31 lets Timer 2 treat the capture/compare modules as pulse-width
    // modulators in any mode, which spoils CCPRxH and the pin.
    cpu->tmr2.rm_ccp(&cpu->ccp1con);
    cpu->tmr2.rm_ccp(&cpu->ccp2con);
    auto *witness = new ResetWitness(cpu);
    witness->address = WITNESS_ADDRESS;
    cpu->registers[WITNESS_ADDRESS] = witness;
    executed.assign(FLASH_BYTES / 2, 0);
    flags_.assign(FLASH_BYTES / 2, 0);
    cpu->setBreakOnReset(false);
    nonvolatile().attach();
    repair_compare();
    classify();
    start_watchdog();
    note_reset(POR_RESET);
    attend();
    return true;
}

void Chip::classify()
{
    for (unsigned word = 0; word < flags_.size(); word++) {
        unsigned opcode = cpu->program_memory[word]->get_opcode();
        uint8_t flag = (opcode & ~1u) == 0x0010   ? RETFIE
                       : (opcode & ~3u) == 0x0008 ? TBLRD
                       : (opcode & ~3u) == 0x000C ? TBLWT
                       : opcode == 0x0004         ? CLRWDT
                                                  : 0;
        flags_[word] = (flags_[word] & BREAK) | flag;
    }
}

void Chip::add_on_reset(std::function<void(RESET_TYPE)> hook)
{
    on_reset_.push_back(hook);
}

void Chip::at(uint64_t cycle, std::function<void()> action)
{
    events_.emplace(cycle, action);
    next_event_ = events_.begin()->first;
}

void Chip::run_events()
{
    while (!events_.empty() && events_.begin()->first <= now()) {
        auto action = events_.begin()->second;
        events_.erase(events_.begin());
        action();
    }
    next_event_ = events_.empty() ? NEVER : events_.begin()->first;
}

void Chip::set_break(unsigned address, bool enabled)
{
    uint8_t &flag = flags_[address / 2 % flags_.size()];
    flag = enabled ? flag | BREAK : flag & ~BREAK;
}

void Chip::clear_statistics()
{
    interrupts[0] = interrupts[1] = InterruptCost();
    stack_depth_max = 0;
    std::fill(executed.begin(), executed.end(), 0);
}

// gpsim pushes the return address in this phase and fetches the vector in
// the next one.  A sleeping core is woken here first, without a push.
void Chip::enter_interrupt(int stack_before, uint64_t start)
{
    if (cpu->stack->pointer <= stack_before)
        return;
    bool high = cpu->intcon.get_interrupt_vector() != LOW_VECTOR_WORD;
    nesting_.push_back({high, start, 0});
    // gpsim 0.31 blocks every interrupt with one flag until retfie.  The chip
    // clears the enable bit of this priority instead, so that high interrupts
    // low; leave_interrupt() sets it again.
    INTCON_16 &intcon = cpu->intcon;
    allow_nesting(intcon, 0);
    bool priorities = cpu->rcon.value.get() & RCON::IPEN;
    unsigned bit = high || !priorities ? INTCON_16::GIEH : INTCON_16::GIEL;
    intcon.value.put(intcon.value.get() & ~bit);
    pending_check_ = true;
}

void Chip::leave_interrupt()
{
    INTCON_16 &intcon = cpu->intcon;
    bool priorities = cpu->rcon.value.get() & RCON::IPEN;
    bool low = priorities && intcon.value.get() & INTCON_16::GIEH;
    unsigned bit = low ? INTCON_16::GIEL : INTCON_16::GIEH;
    intcon.value.put(intcon.value.get() | bit);
    pending_check_ = true;
    if (nesting_.empty())
        return;
    Entry entry = nesting_.back();
    nesting_.pop_back();
    uint64_t spent = now() + RETFIE_REST - entry.start;
    if (!nesting_.empty())
        nesting_.back().nested += spent;
    spent -= entry.nested;
    InterruptCost &cost = interrupts[entry.level];
    cost.entries++;
    cost.total += spent;
    cost.best = std::min(cost.best, spent);
    if (spent > cost.worst) {
        cost.worst = spent;
        cost.worst_at = entry.start;
    }
}

void Chip::attend()
{
    attention_ = false;
    if (reset_seen_)
        finish_reset();
    for (const auto &hook : settle_)
        hook();
}

// The core waits for a flash write; the rest of the chip and the world go on.
void Chip::stand_still(uint64_t until)
{
    uint64_t end = std::min(until, stalled_until_);
    while (now() < end && !reset_seen_) {
        get_cycles().increment();
        if (now() >= next_event_)
            run_events();
    }
    if (now() >= stalled_until_) {
        stalled_until_ = 0;
        classify();
    }
}

// Instructions that gpsim does not model, or whose effect we count.
void Chip::note_instruction(uint8_t flag)
{
    if (flag & CLRWDT)
        feed_watchdog();
    if (flag & TBLWT) {
        unsigned mode = cpu->program_memory[cpu->pc->value]->get_opcode() & 3;
        unsigned pointer =
            cpu->tbl.tblptrl.get_value() | cpu->tbl.tblptrh.get_value() << 8;
        nonvolatile().latch(pointer + (mode == 3), cpu->tbl.tablat.get_value());
    }
}

// Between two instructions: time for the rest of the world.  False when the
// next instruction must not be executed.
bool Chip::boundary(uint64_t until, bool first)
{
    if (now() >= next_event_)
        run_events();
    if (attention_)
        attend();
    if (stop_reason_ != VL_STOP_CYCLE || now() >= until)
        return false;
    if (stalled_until_) {
        stand_still(until);
        if (reset_seen_)
            attend();
        return stalled_until_ == 0;
    }
    if (cpu->mCurrentPhase != cpu->mExecute1Cycle)
        return true;
    if (pending_check_) {
        // The enable bits changed behind gpsim's back: let it look again.
        pending_check_ = false;
        cpu->intcon.put_value(cpu->intcon.value.get());
        if (cpu->mCurrentPhase != cpu->mExecute1Cycle)
            return true;
    }
    unsigned word = cpu->pc->value;
    if (word >= FLASH_BYTES / 2)
        stop_reason_ = VL_STOP_LOST;
    else if (flags_[word] & BREAK && !first)
        stop_reason_ = VL_STOP_ADDRESS;
    else
        executed[word] = 1;
    return stop_reason_ == VL_STOP_CYCLE;
}

int Chip::run(uint64_t until)
{
    Breakpoints &breaks = get_bp();
    stop_reason_ = VL_STOP_CYCLE;
    breaks.clear_global();
    cpu->simulation_mode = eSM_RUNNING;
    bool first = true;
    for (;;) {
        ClockPhase *phase = cpu->mCurrentPhase;
        bool execute = phase == cpu->mExecute1Cycle;
        bool between = execute || stalled_until_ || phase == cpu->mIdle;
        if (between && !boundary(until, first))
            break;
        first = false;
        phase = cpu->mCurrentPhase;
        bool capture = phase == cpu->mCaptureInterrupt;
        execute = phase == cpu->mExecute1Cycle;
        uint8_t flag = execute ? flags_[cpu->pc->value] : 0;
        if (flag & (CLRWDT | TBLWT))
            note_instruction(flag);
        int stack_before = cpu->stack->pointer;
        uint64_t start = now();
        cpu->mCurrentPhase = phase->advance();
        if (capture)
            enter_interrupt(stack_before, start);
        // Table 26-2: both take two cycles; gpsim 0.31 gives them one.
        if (flag & (TBLRD | TBLWT))
            get_cycles().increment();
        if (flag & RETFIE)
            leave_interrupt();
        stack_depth_max =
            std::max(stack_depth_max, unsigned(cpu->stack->pointer));
        if (breaks.global_break) {
            breaks.clear_global();
            stop_reason_ = VL_STOP_HALT;
            break;
        }
    }
    cpu->simulation_mode = eSM_STOPPED;
    return stop_reason_;
}

} // namespace lathe
