// Division that no divisor spoils. A shader may be compiled as if no NaN and no infinity arose, so a divisor is replaced
// before the division.

// dividend / divisor for a positive divisor, 0 for any other. What rounds to 0 on some devices counts as 0.
fn over(dividend: real, divisor: real) -> real {
    let positive = SMALLEST_NORMAL <= divisor;
    return select(real(0.0), dividend, positive) / select(real(1.0), divisor, positive);
}
