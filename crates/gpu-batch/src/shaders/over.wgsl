// Division that is safe for every divisor. A compiler may assume that no NaN and no infinity
// occurs, so the divisor is replaced before the division.

// dividend / divisor for a positive divisor, 0 for any other. A divisor that some devices round
// to 0 counts as 0.
fn over(dividend: real, divisor: real) -> real {
    let positive = SMALLEST_NORMAL <= divisor;
    return select(real(0.0), dividend, positive) / select(real(1.0), divisor, positive);
}
