/* Start-up, the main loop, and the low-priority interrupt.
   SPDX-License-Identifier: Apache-2.0 */

#include "board.h"         /* pin directions */
#include "lathe/guard.h"   /* guard_tick */
#include "lathe/machine.h" /* the machine */
#include "link/commands.h" /* leaving */
#include "link/frame.h"    /* frame_poll */
#include "link/protocol.h" /* states */
#include "motion/path.h"   /* moves */
#include "motion/ramp.h"   /* speed */
#include "motion/stream.h" /* step timer */
#include "panel/inputs.h"  /* buttons */
#include "panel/lcd.h"     /* display */
#include "panel/led.h"     /* status LED */
#include "panel/panel.h"   /* menus */
#include "sfr.h"           /* registers */
#include "store/parts.h"   /* part store */
#include "tick.h"          /* 1 ms */
#include "usb/cdc.h"       /* USB */

/*
 * Configuration words. 20 MHz crystal / 5 -> 4 MHz -> 96 MHz PLL: / 2 gives
 * the 48 MHz of the core (12 MIPS) and of USB. Brown-out at 4.33 V, because
 * 48 MHz needs 4.2 V. Watchdog 4 ms x 64 = 256 ms. Low-voltage programming
 * off: RB5 is a limit switch. The boot block, where the loader lives, cannot
 * be written by any program.
 */
/* clang-format off */
#pragma config PLLDIV=5, CPUDIV=OSC1_PLL2, USBDIV=2, FOSC=HSPLL_HS
#pragma config FCMEN=OFF, IESO=OFF, PWRT=ON, BOR=ON, BORV=1, VREGEN=ON
#pragma config WDT=ON, WDTPS=64, CCP2MX=ON, PBADEN=OFF, LPT1OSC=OFF
#pragma config MCLRE=ON, STVREN=ON, LVP=OFF, ICPRT=OFF, XINST=OFF, DEBUG=OFF
#pragma config CP0=OFF, CP1=OFF, CP2=OFF, CP3=OFF, CPB=OFF, CPD=OFF
#pragma config WRT0=OFF, WRT1=OFF, WRT2=OFF, WRT3=OFF, WRTB=ON, WRTC=OFF
#pragma config WRTD=OFF, EBTR0=OFF, EBTR1=OFF, EBTR2=OFF, EBTR3=OFF
#pragma config EBTRB=OFF
/* clang-format on */

/* One page, as SDCC's small stack model needs. */
#pragma stack 0x700 128

#define ADCON1_DIGITAL 0x0F
#define CMCON_OFF 0x07
#define INTCON2_RBPU 0x80
#define PORTE_RDPU 0x80
#define RCON_IPEN 0x80
#define RCON_CAUSES 0x1F /* set, as a reset clears them */
#define INTCON_BOTH_LEVELS 0xC0
#define PIR1_TMR2IF 0x02
#define PIR2_TMR3IF 0x02 /* asked for by the step interrupt */
#define PIR2_USBIF 0x20

void low_interrupt(void) __interrupt(2)
{
    if (PIR2 & PIR2_TMR3IF) {
        PIR2 &= (uint8_t)~PIR2_TMR3IF;
        ramp_tick();
    }
    if (PIR2 & PIR2_USBIF) {
        usb_service();
    }
    if (PIR1 & PIR1_TMR2IF) {
        PIR1 &= (uint8_t)~PIR1_TMR2IF;
        inputs_read();
        tick_count();
        usb_tick();
        inputs_tick();
        guard_tick();
    }
}

static void set_up_pins(void)
{
    ADCON1 = ADCON1_DIGITAL;
    CMCON = CMCON_OFF;
    LATA = 0;
    LATB = 0;
    LATC = 0;
    LATD = 0;
    LATE = 0;
    TRISA = TRISA_BOARD;
    TRISB = TRISB_BOARD;
    TRISC = TRISC_BOARD;
    TRISD = TRISD_BOARD;
    TRISE = TRISE_BOARD;
    INTCON2 &= (uint8_t)~INTCON2_RBPU;
    PORTE |= PORTE_RDPU;
}

/* startup.asm; never returns. */
void loader_enter(void);

/* Byte code takes 0.3 ms a turn, so what decides is asked when an input has
   changed or the guard has stopped something, and else every 4 ms. Motion and
   frames are served all the time. */
static void serve(void)
{
    static uint8_t served; /* ms */
    static uint8_t seen;   /* inputs */
    uint8_t now = (uint8_t)tick_now();

    if (now != served) {
        served = now;
        if (!(now & 1)) {
            lcd_poll();
            if (now & 2) {
                panel_poll();
            }
        }
        if (!(now & 3) || guard_tripped || inputs_state != seen) {
            seen = inputs_state;
            machine_poll();
            led_poll();
            if (commands_leaving && !--commands_leaving) {
                loader_enter();
            }
        }
    }
    if (machine_state != STATE_IDLE && machine_state != STATE_ALARM) {
        path_poll();
    }
    frame_poll();
}

void main(void)
{
    set_up_pins();
    RCON |= RCON_IPEN | RCON_CAUSES;
    inputs_init();
    stream_init();
    parts_init();
    machine_init();
    tick_init();
    usb_init();
    INTCON = INTCON_BOTH_LEVELS;
    for (;;) {
        __asm__("clrwdt");
        serve();
    }
}
