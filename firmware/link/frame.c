/* Frames: COBS, CRC-16 and repeated requests.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Receiving is byte by byte, so a frame may come in any number of packets, and
 * a packet may hold the end of one frame and the start of the next. COBS: the
 * first byte says after how many bytes the next zero stands; there it is
 * replaced by the distance to the one after. So zero itself only ever ends a
 * frame, and a receiver that lost its place finds it again at the next zero.
 *
 *      body      11 22 00 33              COBS   03 11 22 02 33, then 00
 *
 * The response stays in the USB buffer after it was sent. To repeat it is to
 * send the buffer again.
 */
#include "link/frame.h"

#include "link/crc.h"

#define CRC_SIZE 2
#define BODY_MIN (FRAME_PAYLOAD_AT + CRC_SIZE)

uint8_t frame_request[FRAME_BODY_MAX];
uint8_t frame_length;
uint16_t frame_bad_frames;

/* The frame that is coming in. */
static uint8_t started;     /* a byte has come since the last zero */
static uint8_t body_length; /* bytes so far; FRAME_BODY_MAX + 1 = too many */
static uint8_t until_zero;  /* bytes up to the next COBS byte, 0 = it is next */
static uint16_t request_crc;

static uint8_t packet_at; /* next byte of cdc_packet */

/* The request that cdc_reply answers; none while reply_length is 0. */
static uint8_t answered_seq;
static uint16_t answered_crc;
static uint8_t reply_length;

/* One byte that is not zero. */
static void decode(uint8_t byte)
{
    if (until_zero) {
        until_zero--;
    } else {
        /* A COBS byte: stands for a zero, except as the first of the frame. */
        until_zero = byte - 1;
        byte = 0;
        if (!started) {
            started = 1;
            body_length = 0;
            return;
        }
    }
    if (body_length > FRAME_BODY_MAX) {
        return;
    }
    if (body_length < FRAME_BODY_MAX) {
        frame_request[body_length] = byte;
    }
    body_length++;
}

/* Completes the response of `length` bytes in cdc_reply: seq, code, CRC and the
 * zero at the end; then COBS. */
static void encode(uint8_t length)
{
    __data uint8_t *at;
    uint16_t crc;
    uint8_t distance = 0;

    length += FRAME_PAYLOAD_AT;
    cdc_reply[0] = 0;
    cdc_reply[1] = frame_request[FRAME_SEQ_AT];
    cdc_reply[2] = frame_code | FRAME_RESPONSE_BIT;
    crc = crc16_block(CRC16_INITIAL, cdc_reply + 1, length);
    at = cdc_reply + 1 + length;
    *at++ = crc & 0xFF;
    *at++ = crc >> 8;
    *at = 0;
    reply_length = length + FRAME_ENCODED_MAX - FRAME_BODY_MAX + CRC_SIZE;

    /* Backwards from the end, each zero becomes the distance to the next. */
    do {
        at--;
        distance++;
        if (*at == 0) {
            *at = distance;
            distance = 0;
        }
    } while (at != cdc_reply);
}

/* 1 = the frame that has just ended is a request. */
static uint8_t is_good(void)
{
    uint8_t length = body_length;

    if (until_zero || length < BODY_MIN || length > FRAME_BODY_MAX) {
        return 0;
    }
    length -= CRC_SIZE;
    request_crc = crc16_block(CRC16_INITIAL, frame_request, length);
    return *(__data uint16_t *)(frame_request + length) == request_crc;
}

/* The zero that ends a frame. 1 = there is a request to answer. */
static uint8_t end_frame(void)
{
    uint8_t good = 0;

    if (started) {
        good = is_good();
        if (!good && frame_bad_frames != 0xFFFF) {
            frame_bad_frames++;
        }
    }
    started = 0;
    until_zero = 0;
    return good;
}

/* Takes bytes from the port until a request is complete. 1 = it is. */
static uint8_t receive(void)
{
    uint8_t left = FRAME_BYTES_PER_POLL;
    uint8_t length = cdc_received();
    uint8_t complete = 0;
    uint8_t byte;

    while (length && left && !complete) {
        byte = cdc_packet[packet_at];
        if (byte) {
            decode(byte);
        } else {
            complete = end_frame();
        }
        left--;
        if (++packet_at == length) {
            packet_at = 0;
            length = 0;
            cdc_release();
        }
    }
    return complete;
}

/* Forgets an unfinished frame: the first zero of whoever comes next would end
 * it, and a request that nobody waits for any more would be carried out. */
static void forget(void)
{
    cdc_closed = 0;
    started = 0;
    until_zero = 0;
    packet_at = 0;
    cdc_release();
}

void frame_poll(void)
{
    uint8_t seq;

    if (cdc_closed) {
        forget();
    }
    if (!cdc_send_ready() || !receive()) {
        return;
    }
    seq = frame_request[FRAME_SEQ_AT];
    if (!reply_length || seq != answered_seq || request_crc != answered_crc ||
        frame_code == COMMAND_HELLO) {
        answered_seq = seq;
        answered_crc = request_crc;
        frame_length = body_length - BODY_MIN;
        encode(commands_execute());
    }
    cdc_send(reply_length);
}
