% Written by `lacuna export`: compares with the test vector: to 1e-9 of each output's largest value.
rows = dlmread('test_vector.csv', ',', 1, 0);
expected = rows(:, @NU@ + 1:end);
y = @NAME@(rows(:, 1:@NU@));
largest = max(max(abs(expected), [], 1), realmin);
worst = max(max(abs(y - expected), [], 1)./largest);
fprintf('largest difference from the simulation: %.3g of the largest value\n', worst);
if ~(worst <= 1e-9)
  error('not equal to the simulation');
end
