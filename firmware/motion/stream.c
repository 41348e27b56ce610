/* Step stream: queue between the main loop and the step interrupt.
   SPDX-License-Identifier: Apache-2.0 */

#include "stream.h"
#include "link/protocol.h" /* axes */
#include "sfr.h"           /* CCP2, Timer 1, ports */

#define CCP2IE_MASK 0x01 /* PIE2 */
#define CCP2IF_MASK 0x01 /* PIR2 */
#define TMR3IE_MASK 0x02 /* PIE2: the ramp's, raised by the step interrupt */

#define CCP_COMPARE_INTERRUPT 0x0A /* CCP2CON: match raises CCP2IF only */
#define TIMER1_FREE_RUNNING 0x81   /* T1CON: 16-bit access, 12 MHz, on */
#define START_DELAY_H 0x2E         /* 0x2EE0 cycles = 1 ms */
#define START_DELAY_L 0xE0

extern volatile uint8_t stream_next;
extern volatile uint8_t step_ring[256];
extern volatile uint8_t coils_x[8];
extern volatile uint8_t coils_z[8];
extern volatile uint8_t pattern_x;
extern volatile uint8_t pattern_z;
extern volatile uint8_t phase_x;
extern volatile uint8_t phase_z;
extern volatile uint8_t phase_step;

uint8_t stream_low;

void stream_init(void)
{
    CCP2CON = CCP_COMPARE_INTERRUPT;
    T1CON = TIMER1_FREE_RUNNING;
    IPR2 = CCP2IE_MASK; /* all else is of low priority */
    PIE2 |= TMR3IE_MASK;
}

void stream_coils_on(void)
{
    pattern_x = coils_x[phase_x];
    pattern_z = coils_z[phase_z];
    LATD = pattern_x;
    LATB = pattern_z;
}

void stream_coils_off(void)
{
    pattern_x = 0;
    pattern_z = 0;
    LATD = 0;
    LATB = 0;
}

uint8_t stream_fill(void)
{
    return (uint8_t)(stream_head - stream_tail) >> 1;
}

uint8_t stream_room(void)
{
    return STREAM_ENTRIES - stream_fill();
}

void stream_push(uint8_t flags, uint8_t stretch)
{
    uint8_t head = stream_head;

    step_ring[head] = flags;
    head++;
    step_ring[head] = stretch;
    head++;
    stream_head = head;
}

void stream_prepare(void)
{
    stream_abort();
    stream_head = 0;
    stream_tail = 0;
    stream_count = 0;
    stream_coils_on();
}

void stream_thaw(void)
{
    uint8_t low = TMR1L; /* latches TMR1H */
    uint8_t high = TMR1H;

    high += START_DELAY_H;
    if ((uint8_t)(low + START_DELAY_L) < low) {
        high++;
    }
    CCPR2H = high;
    CCPR2L = low + START_DELAY_L;
    PIR2 &= (uint8_t)~CCP2IF_MASK;
    stream_flags |= STREAM_ACTIVE;
    PIE2 |= CCP2IE_MASK;
}

void stream_start(void)
{
    stream_low = STREAM_ENTRIES;
    stream_flags = STREAM_STOOD;
    stream_thaw();
}

/* The interrupt has turned the phases of the step to come already; a step
   that is never made must not leave them ahead of the rotor. */
static void forget_next_step(void)
{
    uint8_t next = stream_next;

    if (next & STREAM_STEP_X) {
        phase_x += next & STREAM_X_NEGATIVE ? phase_step : -phase_step;
        phase_x &= 7;
        pattern_x = coils_x[phase_x];
    }
    if (next & STREAM_STEP_Z) {
        phase_z += next & STREAM_Z_NEGATIVE ? phase_step : -phase_step;
        phase_z &= 7;
        pattern_z = coils_z[phase_z];
    }
}

void stream_abort(void)
{
    PIE2 &= (uint8_t)~CCP2IE_MASK;
    forget_next_step();
    stream_flags = 0;
    stream_next = 0;
    stream_tail = stream_head;
}

/* The interrupt may change a position between two of its bytes, but not
   twice in the few cycles between two readings: equal readings are true. */
int16_t stream_position(uint8_t axis)
{
    __data const volatile int16_t *position =
        axis == AXIS_X ? &position_x : &position_z;
    int16_t first;
    int16_t second = *position;

    do {
        first = second;
        second = *position;
    } while (first != second);
    return first;
}
