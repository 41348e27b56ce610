; SPDX-License-Identifier: Apache-2.0
; Reads and writes the program memory's latches, each way once; the test looks
; at the cycle in which every instruction begins.

    list p=18f4550
    include <p18f4550.inc>
    config FOSC=HSPLL_HS, PLLDIV=5, CPUDIV=OSC1_PLL2, WDT=OFF, LVP=OFF
    config PBADEN=OFF, XINST=OFF

    org 0
    tblrd*
    tblrd*+
    tblrd*-
    tblrd+*
    tblwt*+
    nop
spin
    bra spin
    end
