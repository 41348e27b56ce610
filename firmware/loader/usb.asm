; Boot loader: the serial interface engine, polled.
; SPDX-License-Identifier: Apache-2.0
;
; Control transfers from a table (descriptors.asm) and the few requests that a
; serial port needs; one packet at a time on the bulk endpoints. The lathe's own
; driver (usb/) is the full one and lives in the program, which may be damaged:
; nothing of it can be used here. Suspend is not honoured: an update in a
; suspended computer does not go on, and the board feeds itself.

        include "loader.inc"

        global  bus_reset, transaction, bulk_answer, bulk_listen
        extern  reads, loader_restart

; Packets that may be waiting in USTAT.
USTAT_DEPTH     equ     4

loader_usb        code
; Bus reset: address 0, only endpoint 0, nothing left of what was.
bus_reset:
        movlb   4
        clrf    UADDR, A
        clrf    UEP0, A
        clrf    UEP1, A
        clrf    UEP2, A
        clrf    notes, A
        clrf    configured, A
        clrf    asked, A
        movlw   USTAT_DEPTH
        movwf   counter, A
forget:
        bcf     UIR, TRNIF, A
        bra     forget_on               ; the next one shows up 6 cycles later
forget_on:
        bra     forget_more
forget_more:
        nop
        decfsz  counter, F, A
        bra     forget
        lfsr    0, EP0_OUT              ; no buffer is anybody's
clear_descriptors:
        clrf    POSTINC0, A
        movlw   LOW SETUP_PACKET
        cpfseq  FSR0L, A
        bra     clear_descriptors
        movlw   LOW SETUP_PACKET
        movwf   LOW EP0_OUT + 2, B
        movlw   HIGH SETUP_PACKET
        movwf   LOW EP0_OUT + 3, B
        movwf   LOW EP0_IN + 3, B
        movwf   LOW EP2_OUT + 3, B
        movlw   LOW CONTROL_DATA
        movwf   LOW EP0_IN + 2, B
        movlw   LOW REQUEST_PACKET
        movwf   LOW EP2_OUT + 2, B
        movlw   HIGH ANSWER_PACKET      ; its low byte is 0
        movwf   LOW EP2_IN + 3, B
        rcall   await_setup
        movlw   EP_CONTROL
        movwf   UEP0, A
        bcf     UCON, PKTDIS, A
        return

; The endpoint 0 takes a SETUP, or DATA0.
await_setup:
        movlw   OWN | CHECK_TOGGLE
await:
        movwf   differs, A
        movlw   EP0_SIZE
        movwf   LOW EP0_OUT + 1, B
        movff   differs, EP0_OUT
        return

; One transaction is over: whose?
transaction:
        movf    USTAT, W, A
        andlw   0x7C
        bcf     UIR, TRNIF, A
        bz      control_out
        xorlw   0x04
        bz      control_in
        xorlw   0x10 ^ 0x04
        bz      bulk_out
        xorlw   0x14 ^ 0x10
        bnz     transaction_done
        btfsc   notes, GOING, A         ; the answer to GO has gone
        goto    loader_restart
transaction_done:
        return

bulk_out:
        movff   EP2_OUT + 1, asked
        tstfsz  asked, A
        return                          ; answered by the main loop
; EP2 OUT takes the next packet.
bulk_listen:
        clrf    asked, A
        movlw   BULK_SIZE
        movwf   LOW EP2_OUT + 1, B
        movff   out_stat, EP2_OUT
        movlw   DATA1
        xorwf   out_stat, F, A
        return

; Sends the `counter` bytes of the answer.
bulk_answer:
        movlw   DATA1
        xorwf   in_stat, F, A
        movff   counter, EP2_IN + 1
        movff   in_stat, EP2_IN
        return

; ---- endpoint 0 -------------------------------------------------------------
control_out:
        movf    LOW EP0_OUT, W, B
        andlw   PID_MASK
        xorlw   PID_SETUP
        bz      setup
        bcf     notes, SENDING, A
        btfss   notes, TAKING, A
        bra     await_setup
        bcf     notes, TAKING, A        ; a line coding, and so what
        rcall   send_status
        bra     await_setup

control_in:
        btfss   notes, ADDRESS_DUE, A
        bra     no_address
        bcf     notes, ADDRESS_DUE, A
        movff   new_address, UADDR
no_address:
        btfss   notes, SENDING, A
        return
        movf    left_to_send, F, A
        bz      transaction_done
; The next packet of a control read.
send_data:
        movf    left_to_send, W, A
        movwf   counter, A
        addlw   -EP0_SIZE & 0xFF
        bnc     send_last
        movlw   EP0_SIZE
        movwf   counter, A
send_last:
        movf    counter, W, A
        subwf   left_to_send, F, A
        movff   counter, EP0_IN + 1
        movlw   HIGH reads
        movwf   TBLPTRH, A
        movff   source_low, TBLPTRL
        lfsr    0, CONTROL_DATA
        movf    counter, F, A
        bz      send_now
send_more:
        tblrd*+
        movff   TABLAT, POSTINC0
        decfsz  counter, F, A
        bra     send_more
        movff   TBLPTRL, source_low
send_now:
        movlw   DATA1
        xorwf   control_stat, F, A
        movff   control_stat, EP0_IN
        return

; An empty DATA1 ends the transfer.
send_status:
        clrf    LOW EP0_IN + 1, B
        movlw   OWN | DATA1 | CHECK_TOGGLE
        movwf   LOW EP0_IN, B
        return

; Fields of the SETUP packet, bank 4.
#define REQUEST_TYPE    LOW SETUP_PACKET
#define REQUEST         LOW SETUP_PACKET + 1
#define VALUE_LOW       LOW SETUP_PACKET + 2
#define INDEX_LOW       LOW SETUP_PACKET + 4
#define LENGTH_LOW      LOW SETUP_PACKET + 6
#define LENGTH_HIGH     LOW SETUP_PACKET + 7

setup:
        clrf    LOW EP0_IN, B
        bcf     UEP0, EPSTALL, A
        clrf    notes, A
        movlw   LOW reads
        movwf   TBLPTRL, A
        movlw   HIGH reads
        movwf   TBLPTRH, A
        movlw   READS
        movwf   entries_left, A
compare_entry:
        lfsr    0, SETUP_PACKET
        clrf    differs, A
        movlw   4
        movwf   counter, A
compare_field:
        tblrd*+
        movf    TABLAT, W, A
        xorwf   POSTINC0, W, A
        iorwf   differs, F, A
        decfsz  counter, F, A
        bra     compare_field
        tblrd*+
        movff   TABLAT, source_low
        tblrd*+
        movff   TABLAT, left_to_send
        movf    differs, W, A
        bz      read_found
        decfsz  entries_left, F, A
        bra     compare_entry
        bra     no_read

read_found:
        movlw   8                       ; GET_CONFIGURATION
        cpfseq  REQUEST, B
        bra     read_limit
        movf    configured, W, A
        addwf   source_low, F, A
read_limit:
        tstfsz  LENGTH_HIGH, B
        bra     read_begin
        movf    LENGTH_LOW, W, B
        cpfsgt  left_to_send, A
        bra     read_begin
        movwf   left_to_send, A
read_begin:
        bsf     notes, SENDING, A
        movlw   OWN | CHECK_TOGGLE
        movwf   control_stat, A
        rcall   send_data
await_data1:
        movlw   OWN | DATA1 | CHECK_TOGGLE
        rcall   await
        bra     enable_packets

no_read:
        movf    REQUEST_TYPE, W, B
        bz      of_device
        xorlw   0x21
        bz      of_port
        xorlw   0x02 ^ 0x21
        bz      of_endpoint
        xorlw   0x01 ^ 0x02
        bnz     refuse
        movf    REQUEST, W, B           ; SET_INTERFACE: there is no other
        xorlw   11
        iorwf   VALUE_LOW, W, B
        bz      accept
refuse:
        movlw   OWN | STALLED
        movwf   LOW EP0_IN, B
        rcall   await                   ; a SETUP is taken all the same
        bra     enable_packets

of_port:
        movf    REQUEST, W, B
        xorlw   0x22                    ; control lines
        bz      accept
        xorlw   0x23 ^ 0x22             ; break
        bz      accept
        xorlw   0x20 ^ 0x23             ; line coding
        bnz     refuse
        bsf     notes, TAKING, A
        bra     await_data1

of_device:
        movf    REQUEST, W, B
        xorlw   5
        bz      set_address
        xorlw   9 ^ 5
        bnz     refuse
        movlw   1                       ; SET_CONFIGURATION
        cpfsgt  VALUE_LOW, B
        bra     set_configuration
        bra     refuse

set_address:
        movff   SETUP_PACKET + 2, new_address
        bsf     notes, ADDRESS_DUE, A
accept:
        rcall   send_status
        rcall   await_setup
enable_packets:
        bcf     UCON, PKTDIS, A
        return

set_configuration:
        movff   SETUP_PACKET + 2, configured
        clrf    UEP1, A
        clrf    UEP2, A
        rcall   restart_out
        rcall   restart_in
        movf    configured, W, A
        bz      unconfigured
        movlw   EP_IN
        movwf   UEP1, A
        movlw   EP_BOTH
        movwf   UEP2, A
        bra     accept
unconfigured:
        clrf    LOW EP2_OUT, B
        bra     accept

; CLEAR_FEATURE(ENDPOINT_HALT): nothing is ever halted, but the toggle begins
; anew.
of_endpoint:
        decf    REQUEST, W, B           ; 1, of feature 0
        iorwf   VALUE_LOW, W, B
        bnz     refuse
        movf    INDEX_LOW, W, B
        xorlw   0x02
        bz      halt_out
        xorlw   0x82 ^ 0x02
        bnz     accept
        rcall   restart_in
        bra     accept
halt_out:
        rcall   restart_out
        bra     accept

restart_in:
        movlw   OWN | DATA1 | CHECK_TOGGLE
        movwf   in_stat, A
        clrf    LOW EP2_IN, B
        return
restart_out:
        movlw   OWN | CHECK_TOGGLE
        movwf   out_stat, A
        clrf    LOW EP2_OUT, B
        bra     bulk_listen
        end
