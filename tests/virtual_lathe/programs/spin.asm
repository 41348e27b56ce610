; SPDX-License-Identifier: Apache-2.0
; Does nothing for ever: the test writes the registers itself.

    list p=18f4550
    include <p18f4550.inc>
    config FOSC=HSPLL_HS, PLLDIV=5, CPUDIV=OSC1_PLL2, WDT=OFF, LVP=OFF
    config PBADEN=OFF, XINST=OFF

    org 0
    movlw 0x0F
    movwf ADCON1, ACCESS
spin
    bra spin
    end
